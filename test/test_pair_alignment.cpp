// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"
#include "../src/base/units.hpp"
#include "../src/pair/pair_alignment.hpp"

namespace opencv_test { namespace {

using hdp::CornerMatch;
using hdp::LightModel;
using hdp::RowModel;

const Size imageSize(320, 240);

Point2d fromCentre(Point2d p) { return Point2d(p.x + 0.5 - 0.5 * imageSize.width, p.y + 0.5 - 0.5 * imageSize.height); }

//! Matches at random places, all right
hdp::CoarseMatches makeMatches(RNG& rng, int count, const RowModel& model)
{
    hdp::CoarseMatches coarse;
    coarse.left.push_back(Mat(imageSize, CV_16U, Scalar(512)));
    coarse.right.push_back(Mat(imageSize, CV_16U, Scalar(512)));
    for (int i = 0; i < count; ++i)
    {
        CornerMatch match;
        match.left = Point(rng.uniform(40, imageSize.width - 10), rng.uniform(30, imageSize.height - 30));
        match.x = match.left.x - rng.uniform(0., 30.);
        match.y = match.left.y + model.at(fromCentre(Point2d(match.x, match.left.y)));
        match.variance = 1e-4;
        match.residual = rng.uniform(1., 9.);
        match.isValid = true;
        coarse.matches.push_back(match);
    }
    return coarse;
}

RowModel makeModel(double offset, double shear, double stretch)
{
    RowModel model;
    model.coefficients = RowModel::Coefficients(offset, shear, stretch, 0, 0);
    return model;
}

TEST(HDPStereo_PairAlignment, rows_of_exact_matches)
{
    RNG rng(61);
    for (int round = 0; round < 20; ++round)
    {
        const RowModel model = makeModel(rng.uniform(-5., 5.), rng.uniform(-4e-3, 4e-3), rng.uniform(-4e-3, 4e-3));
        hdp::CoarseMatches coarse = makeMatches(rng, 200, model);
        for (size_t i = 0; i < coarse.matches.size(); i += 5) // wrong ones
            coarse.matches[i].y += rng.uniform(-9., 9.);
        hdp::RowFindings found;
        hdp::estimateRows(coarse, 0, 64, found);
        ASSERT_TRUE(found.hasRows) << round;
        EXPECT_NEAR(0.02, found.rowError, 0.002) << "least that matches are believed to have";
        for (const CornerMatch& match : coarse.matches)
        {
            const Point2d place = fromCentre(Point2d(match.x, match.left.y));
            ASSERT_NEAR(model.at(place), found.rows.at(place), 0.02) << round;
        }
        std::vector<double> residuals;
        for (const CornerMatch& match : coarse.matches)
            residuals.push_back(match.residual);
        std::sort(residuals.begin(), residuals.end());
        EXPECT_EQ(0, found.noise.layer);
        EXPECT_NEAR(std::sqrt(residuals[residuals.size() / 10] / 1.5) / hdp::greyScale, found.noise.deviation, 1e-12)
            << "of the tenth of the matches that differ least";
    }
}

TEST(HDPStereo_PairAlignment, rows_are_not_believed)
{
    RNG rng(62);
    const auto find = [&](int matches, double offset, int maxOffset) {
        hdp::RowFindings found;
        hdp::estimateRows(makeMatches(rng, matches, makeModel(offset, 0, 0)), 0, maxOffset, found);
        return found;
    };
    const hdp::RowFindings few = find(23, 3, 64), far = find(200, 7, 6), small = find(200, 0.1, 8);
    EXPECT_FALSE(few.hasRows);
    EXPECT_EQ(RowModel::Coefficients(), few.rows.coefficients);
    EXPECT_EQ(0, few.noise.deviation);
    EXPECT_EQ(0, few.rowError);
    EXPECT_FALSE(far.hasRows);
    EXPECT_EQ(RowModel::Coefficients(), far.rows.coefficients);
    EXPECT_TRUE(find(200, 7, 8).hasRows);
    EXPECT_FALSE(small.hasRows) << "not worth the interpolation";
    EXPECT_NEAR(0.1, small.rows.coefficients[0], 0.01) << "reported all the same";
}

TEST(HDPStereo_PairAlignment, row_error_is_that_of_the_matches)
{
    RNG rng(63);
    for (const double deviation : { 0.05, 0.1, 0.3 })
    {
        hdp::CoarseMatches coarse = makeMatches(rng, 1000, makeModel(1, 0, 0));
        for (size_t i = 0; i < coarse.matches.size(); ++i)
            coarse.matches[i].y += i % 5 == 0 ? rng.uniform(-9., 9.) : rng.gaussian(deviation);
        hdp::RowFindings found;
        hdp::estimateRows(coarse, 0, 64, found);
        EXPECT_GE(found.rowError, deviation);
        EXPECT_LE(found.rowError, 1.5 * deviation) << "of the right matches, or nearly";
    }
}

//! Smooth levels, so that the square around a match has the level of the match
Mat smoothLevels(RNG& rng)
{
    Mat image = randomImage(rng, Size(8, 6), CV_16UC1, 4 * 200), smooth;
    resize(image + 80, smooth, imageSize, 0, 0, INTER_CUBIC);
    return smooth;
}

TEST(HDPStereo_PairAlignment, light_of_exact_matches)
{
    RNG rng(63);
    const double white = 255 * hdp::greyScale;
    LightModel models[3];
    models[0].coefficients[0] = 0.7;  // gain
    models[1].coefficients[7] = 0.06; // offset
    models[2].coefficients[1] = 0.1;  // more light on one side
    models[2].coefficients[8] = 0.15; // a curve
    for (const LightModel& model : models)
    {
        hdp::CoarseMatches coarse = makeMatches(rng, 300, RowModel());
        const Mat right = smoothLevels(rng);
        Mat left(imageSize, CV_16U);
        for (CornerMatch& match : coarse.matches)
            match.x = match.left.x; // the same place, of another light
        for (int y = 0; y < left.rows; ++y)
            for (int x = 0; x < left.cols; ++x)
            {
                const double level =
                    model.at(right.at<ushort>(y, x) / white, (x + 0.5) / left.cols - 0.5, (y + 0.5) / left.rows - 0.5);
                left.at<ushort>(y, x) = saturate_cast<ushort>(level * white);
            }
        coarse.left[0] = left;
        coarse.right[0] = right;
        LightModel found;
        ASSERT_TRUE(hdp::estimateLight(coarse, found));
        Mat aligned = right.clone();
        hdp::alignLight(aligned, found, hdp::ImageFrame(aligned.size()));
        EXPECT_LE(cvtest::norm(aligned, left, NORM_L1) / left.total(), 0.5 * hdp::greyScale);
        coarse.left[0] = right;
        EXPECT_FALSE(hdp::estimateLight(coarse, found)) << "the same light";
    }
}

//! The images of a pair, as buildPairPyramids() makes them
std::vector<hdp::LayerImages> layersOf(const Mat& left, const Mat& right, hdp::PairPyramids& pyramids)
{
    const hdp::PyramidPlan plan = { 0, 0, 3, true, false, 0, false };
    std::vector<hdp::LayerImages> images;
    hdp::buildPairPyramids(left, right, hdp::PairMasks(), plan, pyramids, images);
    return images;
}

//! In levels of 255, without a border, whose rows are interpolated from others
double meanDifference(const Mat& a, const Mat& b)
{
    const Rect inside(8, 8, a.cols - 16, a.rows - 16);
    return cvtest::norm(a(inside), b(inside), NORM_L1) / inside.area() / hdp::greyScale;
}

TEST(HDPStereo_PairAlignment, rows_and_light_of_a_pair)
{
    const SyntheticPair pair = makeSyntheticPair(Size(640, 480), 64, 64);
    Mat lower, darker;
    const double shift[] = { 1, 0, 0, 0, 1, 2.5 };
    warpAffine(pair.right, lower, Mat(2, 3, CV_64F, (void*)shift), pair.right.size(), INTER_CUBIC, BORDER_REPLICATE);
    lower.convertTo(darker, CV_8U, 0.75);

    hdp::PairPyramids goodPyramids, pyramids;
    std::vector<hdp::LayerImages> good = layersOf(pair.left, pair.right, goodPyramids);
    std::vector<hdp::LayerImages> images = layersOf(pair.left, darker, pyramids);
    const double before = meanDifference(good[0].right, images[0].right);

    const hdp::AlignmentPlan plan = { 64, 64, true, 3, 0 };
    hdp::AlignmentBuffers buffers;
    hdp::PairFindings findings;
    hdp::alignPair(plan, buffers, images, findings);
    EXPECT_TRUE(findings.hasRows);
    EXPECT_TRUE(findings.hasLight);
    EXPECT_NEAR(2.5, findings.rows.coefficients[0], 0.1);
    for (size_t layer = 0; layer < images.size(); ++layer)
        EXPECT_LE(meanDifference(good[layer].right, images[layer].right), before / 8) << "layer " << layer;

    std::vector<Mat> untouched;
    for (const hdp::LayerImages& layer : good)
        untouched.push_back(layer.right.clone());
    hdp::alignPair(plan, buffers, good, findings);
    EXPECT_FALSE(findings.hasRows);
    EXPECT_FALSE(findings.hasLight);
    for (size_t layer = 0; layer < good.size(); ++layer)
        expectIdentical(untouched[layer], good[layer].right);

    const hdp::AlignmentPlan lightAlone = { 64, 0, true, 0, 0 };
    images = layersOf(pair.left, darker, pyramids);
    hdp::alignPair(lightAlone, buffers, images, findings);
    EXPECT_FALSE(findings.hasRows) << "no rows are to be moved";
    EXPECT_TRUE(findings.hasLight);
}

}} // namespace opencv_test
