// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "emulated_vectors.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/scanlines/volume_scanlines.hpp"
#include "../src/scanlines/volume_scanlines.simd.hpp"

namespace opencv_test { namespace {

const int unit = hdp::CostVolume::scale;
const hdp::VolumePenalties usualPenalties = { 12 * unit, 50 * unit, 20 };

//! Rectangles of one interval each: the full range, one candidate, few, and none
Mat patchyIntervals(RNG& rng, Size size, int numDisparities)
{
    Mat intervals(size, CV_16UC2, Scalar(0, numDisparities - 1));
    for (int i = 0; i < 12; ++i)
    {
        const Point a(rng.uniform(0, size.width), rng.uniform(0, size.height));
        const Point b(rng.uniform(0, size.width), rng.uniform(0, size.height));
        const int first = rng.uniform(0, numDisparities), length = rng.uniform(1, 20);
        const Scalar none(1, 0), some(first, std::min(first + length, numDisparities) - 1);
        intervals(Rect(a, b)).setTo(i % 6 == 5 ? none : some);
    }
    return intervals;
}

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
        volume.create(size, numDisparities, 1);
        for (int p = 0; p < costs.rows; p += 4)
        {
            costs.row(p).setTo(limit - 1);
            costs(p, rng.uniform(0, numDisparities)) = 0;
        }
        for (int p = 0; p < costs.rows; ++p)
            std::copy_n(costs[p], numDisparities, &volume.costs[volume.start(p)]);
    }

    Mat expected(const hdp::VolumePenalties& penalties) const
    {
        return oracle::volumeDisparity(costs, weights, penalties);
    }

    Mat aggregate(const hdp::VolumePenalties& penalties, std::vector<short>& buffers) const
    {
        Mat disparity;
        hdp::aggregateVolume(volume, weights, penalties, buffers, disparity);
        return disparity;
    }
};

TEST(HDPStereo_VolumeScanlines, formula_in_images_of_any_size)
{
    RNG rng(61);
    std::vector<short> buffers; // kept, as the matcher keeps them
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
    std::vector<short> buffers;
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

//! What is excluded costs the most, and is no neighbour of what is not.
TEST(HDPStereo_VolumeScanlines, excluded_candidates)
{
    RNG rng(64);
    std::vector<short> buffers;
    for (int numDisparities : { 7, 33, 64 })
        for (int repetition = 0; repetition < 3; ++repetition)
        {
            SCOPED_TRACE(testing::Message() << numDisparities << " disparities, " << repetition);
            const Size size(27, 13);
            Layer layer(rng, size, numDisparities, 40);
            const Mat own = patchyIntervals(rng, size, numDisparities);
            hdp::excludeCandidates(own, layer.volume);
            for (int p = 0; p < size.area(); ++p)
                for (int d = 0; d < numDisparities; ++d)
                    if (d < own.ptr<Vec2w>()[p][0] || d > own.ptr<Vec2w>()[p][1])
                        layer.costs(p, d) = UCHAR_MAX;
            const Mat expected = oracle::volumeDisparity(layer.costs, layer.weights, usualPenalties, own);
            expectIdentical(expected, layer.aggregate(usualPenalties, buffers));
        }
}

TEST(HDPStereo_VolumeScanlines, candidates_of_half_a_pixel)
{
    RNG rng(63);
    std::vector<short> buffers;
    Layer layer(rng, Size(19, 11), 33);
    const Mat ofPixels = layer.expected(usualPenalties);
    layer.volume.steps = 2;
    Mat expected(ofPixels.size(), CV_16U);
    for (int p = 0; p < (int)expected.total(); ++p)
        expected.ptr<ushort>()[p] = (ushort)(ofPixels.ptr<ushort>()[p] / 2);
    expectIdentical(expected, layer.aggregate(usualPenalties, buffers));
}

//! Of the largest, sums must not overflow.
TEST(HDPStereo_VolumeScanlines, any_penalties)
{
    RNG rng(63);
    std::vector<short> buffers;
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
    std::vector<short> buffers;
    for (int numDisparities : { 1, 16, 37 })
    {
        const Layer layer(rng, Size(20, 10), numDisparities, 1); // all costs are 0
        EXPECT_EQ(0, cv::countNonZero(layer.aggregate(usualPenalties, buffers)));
    }
}

TEST(HDPStereo_VolumeScanlines, any_number_of_threads)
{
    RNG rng(65);
    std::vector<short> buffers;
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
    std::vector<short> buffers;
    for (int numDisparities : { 1, 16, 50 })
    {
        const Size size(14, 8); // one block of scanlines
        const Layer layer(rng, size, numDisparities);
        const hdp::VolumePenalties penalties = { 30, 300, 1e9 };
        std::vector<short> sums(layer.volume.total());
        Mat disparity(size, CV_16UC1);
        hdp::VolumeProblem problem = {
            layer.volume, layer.weights.ptr(), 30, {}, sums.data(), disparity.ptr<ushort>()
        };
        std::fill_n(problem.large, 256, (short)300);
        std::vector<short> lines(problem.lineMemory(std::max(size.width, size.height)));
        hdp::opt_emulated::aggregateRows(problem, Range(0, size.height), lines.data());
        hdp::opt_emulated::aggregateColumns(problem, Range(0, size.width), lines.data());
        expectIdentical(layer.aggregate(penalties, buffers), disparity);
    }
}

}} // namespace opencv_test
