// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The stage once more, with OpenCV's emulation of vectors in place of those of the machine
#define CV_FORCE_SIMD128_CPP

#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/volume_scanlines.hpp"

#undef CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
#undef CV_CPU_OPTIMIZATION_NAMESPACE_END
#define CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN namespace opt_emulated {
#define CV_CPU_OPTIMIZATION_NAMESPACE_END }
#include "../src/volume_scanlines.simd.hpp"

namespace opencv_test {
namespace {

const int unit = hdp::CostVolume::scale;
const hdp::VolumePenalties usualPenalties = { 12 * unit, 50 * unit, 20 };

//! A volume of random costs, and edges
struct Layer
{
    Mat_<uchar> costs; // rows pixels, columns disparities
    Mat weights;
    hdp::CostVolume volume;

    //! Costs below a limit. With a small one there are ties and long flat stretches; every fourth pixel has one
    //! candidate that stands out.
    Layer(RNG& rng, Size size, int numDisparities, int limit = 256)
        : costs(randomImage(rng, Size(numDisparities, size.area()), CV_8UC1, limit)),
          weights(oracle::edgeWeights(patchyImage(rng, size, CV_8UC3)))
    {
        for (int p = 0; p < costs.rows; p += 4)
        {
            costs.row(p).setTo(limit - 1);
            costs(p, rng.uniform(0, numDisparities)) = 0;
        }
        volume.create(size, numDisparities);
        for (int p = 0; p < costs.rows; ++p)
            std::copy(costs[p], costs[p] + numDisparities, volume.costs.ptr() + (size_t)p * volume.pitch);
    }

    Mat expected(const hdp::VolumePenalties& penalties) const
    {
        return oracle::volumeDisparity(costs, weights, penalties);
    }

    Mat aggregate(const hdp::VolumePenalties& penalties, hdp::VolumeScanlineBuffers& buffers) const
    {
        Mat disparity;
        hdp::aggregateVolume(volume, weights, penalties, buffers, disparity);
        return disparity;
    }
};

TEST(HDPStereo_VolumeScanlines, formula_in_images_of_any_size)
{
    RNG rng(61);
    hdp::VolumeScanlineBuffers buffers; // kept, as the matcher keeps them
    for (int height : { 1, 2, 3, 7, 8, 9, 17, 30 })
        for (int width : { 1, 2, 3, 15, 16, 17, 31, 33 })
        {
            SCOPED_TRACE(testing::Message() << width << " x " << height);
            const Layer layer(rng, Size(width, height), 1 + (5 * height + width) % 40);
            expectIdentical(layer.expected(usualPenalties), layer.aggregate(usualPenalties, buffers));
        }
}

TEST(HDPStereo_VolumeScanlines, formula_for_any_number_of_disparities)
{
    RNG rng(62);
    hdp::VolumeScanlineBuffers buffers;
    for (int numDisparities = 1; numDisparities <= 70; ++numDisparities)
        for (int limit : { 3, 256 })
        {
            SCOPED_TRACE(testing::Message() << numDisparities << " disparities, costs below " << limit);
            const Layer layer(rng, Size(19, 11), numDisparities, limit);
            for (int small : { 0, 1, 12 * unit })
            {
                const hdp::VolumePenalties penalties = { small, 50 * unit, 20 };
                expectIdentical(layer.expected(penalties), layer.aggregate(penalties, buffers));
            }
        }
}

//! Of the largest, sums must not overflow.
TEST(HDPStereo_VolumeScanlines, any_penalties)
{
    RNG rng(63);
    hdp::VolumeScanlineBuffers buffers;
    const int largest = hdp::VolumePenalties::largest;
    for (int numDisparities : { 3, 33 })
    {
        const Layer layer(rng, Size(43, 38), numDisparities);
        for (int small : { 0, 1, 40, 400, largest })
            for (int large : { 0, 1, 100, largest })
                for (double gamma : { 1e-300, 1., 20., 1e300 })
                {
                    SCOPED_TRACE(testing::Message()
                                 << numDisparities << " disparities, " << small << ", " << large << ", " << gamma);
                    const hdp::VolumePenalties penalties = { small, large, gamma };
                    expectIdentical(layer.expected(penalties), layer.aggregate(penalties, buffers));
                }
    }
}

TEST(HDPStereo_VolumeScanlines, lowest_disparity_wins_a_tie)
{
    RNG rng(64);
    hdp::VolumeScanlineBuffers buffers;
    for (int numDisparities : { 1, 16, 37 })
    {
        const Layer layer(rng, Size(20, 10), numDisparities, 1); // all costs are 0
        EXPECT_EQ(0, cv::countNonZero(layer.aggregate(usualPenalties, buffers)));
    }
}

TEST(HDPStereo_VolumeScanlines, any_number_of_threads)
{
    RNG rng(65);
    hdp::VolumeScanlineBuffers buffers;
    const Layer layer(rng, Size(75, 61), 29);
    const int threads = cv::getNumThreads();
    const Mat expected = layer.aggregate(usualPenalties, buffers);
    for (int count : { 1, 2, 3, 8 })
    {
        cv::setNumThreads(count);
        expectIdentical(expected, layer.aggregate(usualPenalties, buffers));
    }
    cv::setNumThreads(threads);
}

TEST(HDPStereo_VolumeScanlines, lanes_without_vectors)
{
    RNG rng(66);
    hdp::VolumeScanlineBuffers buffers;
    for (int numDisparities : { 1, 16, 50 })
    {
        const Size size(14, 8); // one block of scanlines
        const Layer layer(rng, size, numDisparities);
        hdp::VolumeProblem problem;
        problem.costs = layer.volume.costs.ptr();
        problem.weights = layer.weights.ptr();
        problem.size = size;
        problem.numDisparities = numDisparities;
        problem.pitch = layer.volume.pitch;
        problem.small = 30;
        for (short& large : problem.large)
            large = 300;
        const hdp::VolumePenalties penalties = { 30, 300, 1e9 };
        Mat sums(layer.volume.costs.size(), CV_16SC1), disparity(size, CV_16UC1);
        problem.sums = sums.ptr<short>();
        problem.disparity = disparity.ptr<ushort>();
        std::vector<short> lines(problem.lineMemory(std::max(size.width, size.height)));
        hdp::opt_emulated::aggregateRows(problem, Range(0, size.height), lines.data());
        hdp::opt_emulated::aggregateColumns(problem, Range(0, size.width), lines.data());
        expectIdentical(layer.aggregate(penalties, buffers), disparity);
    }
}

} // namespace
} // namespace opencv_test
