// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"
#include "systems.hpp"
#include "../src/census_cost.hpp"
#include "../src/color_gradient_cost.hpp"
#include "../src/disparity_confidence.hpp"
#include "../src/disparity_units.hpp"
#include "../src/image_pyramid.hpp"
#include "../src/pair_pyramids.hpp"

namespace opencv_test {
namespace {

////////////////////////////////////////////// the stage //////////////////////////////////////////////

//! A cost of a pair of grey images
Ptr<hdp::MatchingCost> makeCost(const Mat& left, const Mat& right, int numDisparities, bool isCensus)
{
    if (!isCensus)
    {
        const hdp::ColorGradientParams params = { 10, 2, 0.11f, 1 };
        const Ptr<hdp::ColorGradientCost> cost = makePtr<hdp::ColorGradientCost>();
        cost->prepare(left, right, numDisparities, params);
        return cost;
    }
    Mat leftGrey, rightGrey;
    hdp::greyLevels(left, leftGrey);
    hdp::greyLevels(right, rightGrey);
    const Ptr<hdp::CensusCost> cost = makePtr<hdp::CensusCost>();
    cost->prepare(leftGrey, rightGrey, numDisparities, 7);
    return cost;
}

//! The confidence of one pixel, from its definition.
double confidenceOf(int x, int y, const Mat& disparity, int numDisparities, const hdp::MatchingCost& cost)
{
    const auto d = [&](int column, int row) { return (int)disparity.at<ushort>(row, column); };
    const Rect image(0, 0, disparity.cols, disparity.rows);
    double distance = 64;
    for (int v = 0; v < disparity.rows; ++v)
        for (int u = 0; u < disparity.cols; ++u)
            for (const Point& step : { Point(1, 0), Point(-1, 0), Point(0, 1), Point(0, -1) })
                if (image.contains(Point(u, v) + step) &&
                    std::abs(d(u, v) - d(u + step.x, v + step.y)) > 1.5 * hdp::subpixelScale)
                    distance = std::min(distance, std::sqrt((double)(x - u) * (x - u) + (double)(y - v) * (y - v)));

    double own = 0, others = 0;
    for (int v = y - 10; v <= y + 10; ++v)
        for (int u = x - 10; u <= x + 10; ++u)
        {
            const int column = std::min(std::max(u, 0), disparity.cols - 1);
            const int row = std::min(std::max(v, 0), disparity.rows - 1), pixel = row * disparity.cols + column;
            const int winner = hdp::wholeDisparity(d(column, row));
            const auto costOf = [&](int candidate) {
                float costs[4];
                cost.evaluate(&pixel, 1, candidate, 4, costs);
                return (double)costs[0];
            };
            double sum = 0;
            int count = 0;
            for (int other : { winner - 2, winner + 2 })
                if (other >= 0 && other < numDisparities)
                {
                    sum += costOf(other);
                    ++count;
                }
            own += costOf(winner);
            others += count ? sum / count : costOf(winner);
        }
    const double unique = others > own ? (others - own) / (others + own) : 0;

    const auto right = [&](int column) { return column - cvRound(d(column, y) / (double)hdp::subpixelScale); };
    bool isVisible = right(x) >= 0;
    for (int u = 0; u < disparity.cols; ++u)
        if (right(u) == right(x) && d(u, y) - d(x, y) > hdp::subpixelScale)
            isVisible = false;
    return 255 * std::sqrt(distance / 64 * unique) / (isVisible ? 1 : 2);
}

TEST(HDPStereo_DisparityConfidence, by_its_definition)
{
    RNG rng(41);
    for (bool isCensus : { true, false })
        for (const Size& size : { Size(1, 1), Size(1, 9), Size(9, 1), Size(43, 31), Size(5, 300) })
            for (int numDisparities : { 1, 2, 3, 12 })
            {
                SCOPED_TRACE(testing::Message()
                             << "census " << isCensus << ", " << size << ", " << numDisparities << " disparities");
                const Mat right = patchyImage(rng, size, CV_8UC1);
                Mat left, disparity;
                cv::add(right, randomImage(rng, size, CV_8UC1, 10), left);
                const Ptr<hdp::MatchingCost> cost = makeCost(left, right, numDisparities, isCensus);
                // Blocks of disparities that differ within themselves by less than a pixel
                patchyImage(rng, size, CV_8UC1, 12)
                    .convertTo(disparity, CV_16U, (numDisparities - 1) * hdp::subpixelScale / 255.);
                Mat confidence;
                hdp::disparityConfidence(disparity, numDisparities, *cost, confidence);
                ASSERT_EQ(CV_8UC1, confidence.type());
                ASSERT_EQ(size, confidence.size());
                const int step = size.area() > 1000 ? 7 : 1; // the definition is slow
                for (int i = 0; i < size.area(); i += step)
                {
                    const int x = i % size.width, y = i / size.width;
                    const double expected = confidenceOf(x, y, disparity, numDisparities, *cost);
                    ASSERT_NEAR(expected, confidence.at<uchar>(y, x), 0.51) << "at " << x << ", " << y;
                }
            }
}

//! A pair of a textured plane in front of nothing, with some noise, and its confidence for a map
struct TexturedPlane
{
    enum
    {
        numDisparities = 16,
        disparity = 6
    };
    Mat left, right;
    bool isCensus;

    explicit TexturedPlane(bool census) : isCensus(census)
    {
        RNG rng(42);
        const Mat texture = randomImage(rng, Size(200, 120), CV_8UC1, 200);
        left = texture(Rect(0, 0, 180, 120)).clone();
        right = texture(Rect(disparity, 0, 180, 120)).clone();
        left += randomImage(rng, left.size(), CV_8UC1, 8);
        right += randomImage(rng, right.size(), CV_8UC1, 8);
    }

    Mat map() const { return Mat(left.size(), CV_16U, Scalar(16 * disparity)); }

    Mat confidence(const Mat& map) const
    {
        Mat result;
        hdp::disparityConfidence(map, numDisparities, *makeCost(left, right, numDisparities, isCensus), result);
        return result;
    }
};

TEST(HDPStereo_DisparityConfidence, texture)
{
    for (bool isCensus : { true, false })
    {
        TexturedPlane plane(isCensus);
        RNG rng(43);
        for (Mat* image : { &plane.left, &plane.right }) // noise alone
            Mat(randomImage(rng, Size(90, 120), CV_8UC1, 8) + 100).copyTo(image->colRange(90, 180));
        const Mat confidence = plane.confidence(plane.map());
        const double textured = cv::mean(confidence.colRange(25, 65))[0],
                     plain = cv::mean(confidence.colRange(115, 155))[0];
        EXPECT_GT(textured, 2 * plain) << "census " << isCensus;
    }
}

TEST(HDPStereo_DisparityConfidence, mismatch)
{
    for (bool isCensus : { true, false })
    {
        const TexturedPlane plane(isCensus);
        Mat wrong = plane.map();
        const Rect patch(60, 30, 60, 60), inside(75, 45, 30, 30);
        wrong(patch).setTo(Scalar(16 * (TexturedPlane::disparity + 4)));
        const double correct = cv::mean(plane.confidence(plane.map())(inside))[0];
        EXPECT_GT(correct, 3 * cv::mean(plane.confidence(wrong)(inside))[0]) << "census " << isCensus;
    }
}

TEST(HDPStereo_DisparityConfidence, steps)
{
    const TexturedPlane plane(true);
    Mat map = plane.map();
    map.rowRange(0, 40) += 24; // 1.5 pixels are none
    expectIdentical(Mat(1, 180, CV_8U, Scalar(0)), Mat(plane.confidence(map).row(39) == 0));
    map.rowRange(0, 40) += 1;
    const Mat confidence = plane.confidence(map);
    EXPECT_EQ(0, cv::countNonZero(confidence.rowRange(39, 41)));
    double last = 0;
    for (int y = 41; y < 110; y += 10) // away from the step
    {
        const double now = cv::mean(confidence(Range(y, y + 10), Range(60, 120)))[0];
        EXPECT_GT(now, last);
        last = now;
    }
}

//! The pixels beside a nearer surface that it hides from the right image, and as many on its other side that it does not
TEST(HDPStereo_DisparityConfidence, hidden_pixels)
{
    const TexturedPlane plane(true);
    Mat map = plane.map(), mirrored = plane.map();
    const int nearer = 16 * (TexturedPlane::disparity + 8);
    map.colRange(80, 180).setTo(Scalar(nearer));    // maps to columns from 66 on, the pixels 72..79 to 66..73
    mirrored.colRange(0, 64).setTo(Scalar(nearer)); // hides none of the pixels behind it
    const Range rows(30, 90);
    const double hidden = cv::mean(plane.confidence(map)(rows, Range(72, 79)))[0];
    const double visible = cv::mean(plane.confidence(mirrored)(rows, Range(65, 72)))[0];
    EXPECT_GT(visible, 1.5 * hidden);
    EXPECT_GT(hidden, 0);

    // Those whose match is outside of the right image
    const Mat confidence = plane.confidence(plane.map());
    EXPECT_GT(cv::mean(confidence.colRange(6, 10))[0], 1.5 * cv::mean(confidence.colRange(2, 6))[0]);
}

TEST(HDPStereo_DisparityConfidence, any_number_of_threads)
{
    const int threads = cv::getNumThreads();
    RNG rng(44);
    const Mat left = patchyImage(rng, Size(90, 500), CV_8UC1);
    Mat disparity, right;
    cv::add(left, randomImage(rng, left.size(), CV_8UC1, 10), right);
    patchyImage(rng, left.size(), CV_8UC1, 40).convertTo(disparity, CV_16U, 0.5);
    for (bool isCensus : { true, false })
    {
        const Ptr<hdp::MatchingCost> cost = makeCost(left, right, 9, isCensus);
        Mat expected;
        for (int n : { 1, 2, 8 })
        {
            Mat confidence;
            cv::setNumThreads(n);
            hdp::disparityConfidence(disparity, 9, *cost, confidence);
            cv::setNumThreads(threads);
            if (expected.empty())
                expected = confidence;
            EXPECT_GT(cv::countNonZero(confidence), 1000);
            expectIdentical(expected, confidence);
        }
    }
}

////////////////////////////////////////////// the matcher //////////////////////////////////////////////

const SyntheticPair& testPair()
{
    static const SyntheticPair pair = makeSyntheticPair(Size(301, 181), 48, 9);
    return pair;
}

Mat confidenceOf(const HDPTreeMatcher& matcher)
{
    Mat confidence;
    matcher.getConfidence(confidence);
    return confidence;
}

//! Percentages of the pixels whose disparities are wrong by 2 or more: of all, and of the more confident half
void badOfAllAndOfBetterHalf(const Mat& disparity, const Mat& confidence, const SyntheticPair& pair, double& all,
                             double& better)
{
    std::vector<std::pair<int, bool>> pixels; // less confidence, whether it is bad: so bad ones come last among equals
    for (int y = 0; y < disparity.rows; ++y)
        for (int x = 0; x < disparity.cols; ++x)
        {
            const double error = disparity.at<short>(y, x) / 16. - pair.truth.at<float>(y, x);
            pixels.push_back(std::make_pair(255 - confidence.at<uchar>(y, x), std::abs(error) >= 2));
        }
    std::sort(pixels.begin(), pixels.end());
    const auto percentage = [&](size_t count) {
        const auto isBad = [](const std::pair<int, bool>& pixel) { return pixel.second; };
        return 100. * (double)std::count_if(pixels.begin(), pixels.begin() + (ptrdiff_t)count, isBad) / (double)count;
    };
    all = percentage(pixels.size());
    better = percentage(pixels.size() / 2);
}

TEST(HDPStereo_DisparityConfidence, better_half_has_a_third_of_the_errors)
{
    for (const System& system : presets)
    {
        SCOPED_TRACE(system.name);
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 48, system.preset);
        const Mat disparity = match(*matcher, testPair().left, testPair().right);
        double all, better;
        badOfAllAndOfBetterHalf(disparity, confidenceOf(*matcher), testPair(), all, better);
        EXPECT_GT(all, 1);
        EXPECT_LT(3 * better, all);
    }
}

TEST(HDPStereo_DisparityConfidence, of_the_last_pair)
{
    const Mat left = testPair().left, right = testPair().right;
    for (const System& system : presets)
    {
        SCOPED_TRACE(system.name);
        const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 48, system.preset);
        EXPECT_TRUE(confidenceOf(*matcher).empty());
        const Mat disparity = match(*matcher, left, right);
        const Mat confidence = confidenceOf(*matcher);
        ASSERT_EQ(CV_8UC1, confidence.type());
        ASSERT_EQ(left.size(), confidence.size());
        EXPECT_GT(cv::countNonZero(confidence), left.size().area() / 2);

        expectIdentical(confidence, confidenceOf(*matcher));
        matcher->setNumDisparities(3); // for the next pair
        matcher->setMinDisparity(5);
        matcher->setUseSubpixel(!matcher->getUseSubpixel());
        matcher->setDisp12MaxDiff(1);
        expectIdentical(confidence, confidenceOf(*matcher));
        const Mat smaller = match(*matcher, left.rowRange(0, 90).clone(), right.rowRange(0, 90).clone());
        EXPECT_EQ(smaller.size(), confidenceOf(*matcher).size());

        matcher->setNumDisparities(48);
        matcher->setMinDisparity(0);
        matcher->setUseSubpixel(!matcher->getUseSubpixel());
        matcher->setDisp12MaxDiff(-1);
        expectIdentical(disparity, match(*matcher, left, right)); // asking for the confidence has changed nothing
        expectIdentical(confidence, confidenceOf(*matcher));
    }
}

TEST(HDPStereo_DisparityConfidence, none_after_an_exception)
{
    const Mat left = testPair().left, right = testPair().right;
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 48);
    Mat disparity, confidence = match(*matcher, left, right).clone();
    EXPECT_FALSE(confidenceOf(*matcher).empty());
    EXPECT_THROW(matcher->compute(left, right.colRange(1, 100), disparity), cv::Exception);
    matcher->getConfidence(confidence);
    EXPECT_TRUE(confidence.empty());
    match(*matcher, left, right);
    EXPECT_FALSE(confidenceOf(*matcher).empty());
}

TEST(HDPStereo_DisparityConfidence, invalid_pixels_have_none)
{
    for (const System& system : { presetFast, presetUltrafast, presetPaper })
        for (int depth : { CV_16S, CV_32F })
        {
            SCOPED_TRACE(testing::Message() << system.name << ", depth " << depth);
            const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 48, system.preset);
            match(*matcher, testPair().left, testPair().right);
            Mat expected = confidenceOf(*matcher);
            matcher->setDisp12MaxDiff(1);
            matcher->setSpeckleWindowSize(200);
            matcher->setSpeckleRange(1);
            matcher->setDisparityDepth(depth);
            const Mat disparity = match(*matcher, testPair().left, testPair().right), invalid = disparity < 0;
            EXPECT_GT(cv::countNonZero(invalid), 0);
            EXPECT_GT(cv::countNonZero(expected & invalid), 0);
            expected.setTo(Scalar(0), invalid);
            expectIdentical(expected, confidenceOf(*matcher));
        }
}

TEST(HDPStereo_DisparityConfidence, minDisparity_does_not_matter)
{
    const int shift = 7;
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(shift, 48 - shift);
    match(*matcher, testPair().left, testPair().right);
    // Where the left pixels have matches inside, these are the same ones as of a right image moved by minDisparity.
    Mat moved;
    hdp::shiftColumns(testPair().right, shift, 0, moved);
    const Ptr<HDPTreeMatcher> fromZero = HDPTreeMatcher::create(0, 48 - shift);
    match(*fromZero, testPair().left, moved);
    expectIdentical(confidenceOf(*fromZero), confidenceOf(*matcher));
}

TEST(HDPStereo_DisparityConfidence, kinds_of_arrays)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 48);
    match(*matcher, testPair().left, testPair().right);
    const Mat expected = confidenceOf(*matcher);
    Mat_<uchar> typed;
    matcher->getConfidence(typed);
    expectIdentical(expected, typed);
    UMat device;
    matcher->getConfidence(device);
    expectIdentical(expected, device.getMat(ACCESS_READ));
    Mat_<float> other;
    EXPECT_THROW(matcher->getConfidence(other), cv::Exception);
}

TEST(HDPStereo_DisparityConfidence, images_of_any_size)
{
    RNG rng(45);
    for (const System& system : presets)
        for (const Size& size : { Size(1, 1), Size(2, 3), Size(1, 40), Size(40, 1), Size(63, 5), Size(7, 66) })
        {
            SCOPED_TRACE(testing::Message() << system.name << ", " << size);
            const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, 20, system.preset);
            match(*matcher, randomImage(rng, size, CV_8UC3), randomImage(rng, size, CV_8UC3));
            EXPECT_EQ(size, confidenceOf(*matcher).size());
        }
}

} // namespace
} // namespace opencv_test
