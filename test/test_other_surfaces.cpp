// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "window_prediction.hpp"

namespace opencv_test { namespace {

const int scale = 16, apart = 5 * scale;

//! A layer whose surfaces are about those of the layer above
struct Layer
{
    Mat left, right;
    int numDisparities;

    Layer(RNG& rng, const Mat& upper, Size size, int numDisparities_) : numDisparities(numDisparities_)
    {
        left = randomImage(rng, size, CV_16UC1, 1021);
        right = randomImage(rng, size, CV_16UC1, 1021);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
            {
                const int v = std::min(y / 2 + y / 9 % 4, upper.rows - 1),
                          u = std::min(x / 2 + x / 7 % 5, upper.cols - 1);
                const int d = 2 * upper.at<ushort>(v, u) / scale;
                if (x >= d && rng.uniform(0, 20) > 0)
                    right.at<ushort>(y, x - d) = left.at<ushort>(y, x);
            }
    }
};

//! The lowest cost of a run over the 4 x 4 pixels of a group
int costOf(const Layer& layer, const oracle::CensusCost& census, int y, int x, int surface)
{
    const int row = std::min(y / 2 * 4, layer.left.rows - 4), column = std::min(x / 2 * 4, layer.left.cols - 4);
    const int nearest = cvFloor(surface / (double)scale + 0.5);
    const int first = std::max(std::min(nearest - 3, layer.numDisparities + 1 - 8), -1);
    int lowest = 255;
    for (int d = first; d < first + 8; ++d)
    {
        int sum = 0;
        for (int i = 0; i < 16; ++i)
            sum += census(row + i / 4, column + i % 4, d);
        lowest = std::min(lowest, sum);
    }
    return lowest;
}

//! Those apart from the ones before
void addSurface(std::vector<int>& surfaces, int surface)
{
    for (int other : surfaces)
        if (std::abs(other - surface) < apart)
            return;
    if (surfaces.size() < 8)
        surfaces.push_back(surface);
}

std::vector<int> surfacesAround(const Prediction& prediction, int y, int x)
{
    const Size blocks((prediction.upper.cols + 3) / 4, (prediction.upper.rows + 3) / 4);
    const Point own(x / 4, y / 4);
    std::vector<Point> around(1, own);
    for (int v = own.y - 1; v <= own.y + 1; ++v)
        for (int u = own.x - 1; u <= own.x + 1; ++u)
            if (Rect(Point(), blocks).contains(Point(u, v)))
                around.push_back(Point(u, v));
    std::vector<int> surfaces;
    for (const Point& block : around)
        for (const Mat& map : { prediction.upper, prediction.unfiltered })
        {
            double min, max;
            minMaxLoc(map(Rect(block * 4, Size(4, 4)) & Rect(Point(), map.size())), &min, &max);
            addSurface(surfaces, 2 * (int)min);
            addSurface(surfaces, 2 * (int)max);
        }
    return surfaces;
}

int otherSurface(const Prediction& prediction, const Layer& layer, const oracle::CensusCost& census, int y, int x)
{
    const int own = 2 * prediction.upper.at<ushort>(y, x), usual = oracle::usualSurface(prediction, y, x);
    if (std::min(layer.left.rows, layer.left.cols) < 4 || usual == own)
        return usual;
    std::vector<int> others;
    int same = usual; // the listed one that it is
    for (int surface : surfacesAround(prediction, y, x))
        if (std::abs(surface - own) >= apart && std::abs(surface - usual) >= apart)
            others.push_back(surface);
        else if (same == usual && std::abs(surface - usual) < apart)
            same = surface;
    int result = usual, lowest = others.empty() ? 0 : costOf(layer, census, y, x, same) - 16;
    for (int surface : others)
    {
        const int cost = costOf(layer, census, y, x, surface);
        if (cost < lowest)
        {
            lowest = cost;
            result = surface;
        }
    }
    return result;
}

TEST(HDPStereo_OtherSurfaces, rule)
{
    RNG rng(60);
    hdp::SurfaceBuffers buffers;
    Mat others, usual;
    int changed = 0;
    for (int blockSize : { 7, 5, 3 })
        for (const Size& size : { Size(3, 2), Size(8, 3), Size(70, 41), Size(161, 36) })
            for (int numDisparities : { 1, 12, 70 })
            {
                SCOPED_TRACE(testing::Message()
                             << size << ", disparities " << numDisparities << ", block " << blockSize);
                const Size upperSize(std::max(size.width / 2, 1), std::max(size.height / 2, 1));
                Prediction prediction(patchesAbove(rng, upperSize, numDisparities, 7));
                prediction.addThinStructuresAndMatches(rng, numDisparities);
                const Layer layer(rng, prediction.upper, size, numDisparities);
                hdp::CensusCost cost;
                cost.prepare(layer.left, layer.right, numDisparities, blockSize);
                hdp::findOtherSurfaces(prediction.forStage(), &cost, numDisparities, buffers, others);
                ASSERT_EQ(upperSize, others.size());
                ASSERT_EQ(CV_16UC1, others.type());
                hdp::findOtherSurfaces(prediction.forStage(), nullptr, numDisparities, buffers, usual);
                const oracle::CensusCost census(layer.left, layer.right, blockSize);
                for (int y = 0; y < upperSize.height; ++y)
                    for (int x = 0; x < upperSize.width; ++x)
                    {
                        ASSERT_EQ(otherSurface(prediction, layer, census, y, x), others.at<ushort>(y, x))
                            << "y " << y << " x " << x;
                        ASSERT_EQ(oracle::usualSurface(prediction, y, x), usual.at<ushort>(y, x));
                        changed += others.at<ushort>(y, x) != usual.at<ushort>(y, x);
                    }
            }
    EXPECT_GT(changed, 100) << "nothing is tested where all surfaces are the usual ones";
}

//! A gap between two things in front of a background: the farthest surface is not always the one to be offered.
TEST(HDPStereo_OtherSurfaces, census_decides_between_two)
{
    const Size size(120, 40);
    const int numDisparities = 64, back = 4, middle = 20, front = 50;
    RNG rng(61);
    Mat upper(size.height / 2, size.width / 2, CV_16UC1, Scalar(middle * scale / 2));
    upper.colRange(31, 34).setTo(back * scale / 2);
    upper.colRange(34, upper.cols).setTo(front * scale / 2);
    const Prediction prediction(upper);
    Mat left = randomImage(rng, size, CV_16UC1, 1021), right = randomImage(rng, size, CV_16UC1, 1021);
    for (int y = 0; y < size.height; ++y) // all of it is background in truth
        for (int x = back; x < size.width; ++x)
            right.at<ushort>(y, x - back) = left.at<ushort>(y, x);
    hdp::CensusCost cost;
    cost.prepare(left, right, numDisparities, 7);
    hdp::SurfaceBuffers buffers;
    Mat others;
    hdp::findOtherSurfaces(prediction.forStage(), &cost, numDisparities, buffers, others);
    EXPECT_EQ(front * scale, oracle::usualSurface(prediction, 10, 32 - 1)) << "the farthest one";
    EXPECT_EQ(back * scale, others.at<ushort>(10, 30));
}

}} // namespace opencv_test
