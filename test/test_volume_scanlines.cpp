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

//! The trees are the given groups of pixels; nothing else of the forest counts.
hdp::CostVolume createVolume(const Mat& intervals)
{
    std::map<std::pair<int, int>, std::vector<int>> pixels; // by interval
    for (int p = 0; p < (int)intervals.total(); ++p)
    {
        const Vec2w interval = intervals.at<Vec2w>(p / intervals.cols, p % intervals.cols);
        pixels[std::make_pair(interval[0], interval[1])].push_back(p);
    }
    hdp::DisparityForest forest;
    forest.links.create(intervals.size(), CV_8U);
    for (const auto& group : pixels)
    {
        const hdp::DisparityInterval interval = { (ushort)group.first.first, (ushort)group.first.second };
        const hdp::DisparityTree tree = { group.second[0], (int)group.second.size(), interval };
        forest.trees.push_back(tree);
    }
    hdp::CostVolume volume;
    volume.create(forest);
    size_t tree = 0;
    for (const auto& group : pixels)
        volume.place(forest, tree++, group.second.data());
    return volume;
}

//! Rectangles of one interval each: the full range, one candidate, few, none, and so far apart that they do not meet
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
    Mat weights, intervals;
    hdp::CostVolume volume;

    //! Costs below a limit. With a small one there are ties and long flat stretches; every fourth pixel has one
    //! candidate that stands out.
    Layer(RNG& rng, Size size, int numDisparities, int limit = 256, bool isFull = true)
        : costs(randomImage(rng, Size(numDisparities, size.area()), CV_8UC1, limit)),
          weights(oracle::edgeWeights(patchyImage(rng, size, CV_8UC3))),
          intervals(isFull ? Mat(size, CV_16UC2, Scalar(0, numDisparities - 1))
                           : patchyIntervals(rng, size, numDisparities)),
          volume(createVolume(intervals))
    {
        for (int p = 0; p < costs.rows; p += 4)
        {
            costs.row(p).setTo(limit - 1);
            costs(p, rng.uniform(0, numDisparities)) = 0;
        }
        for (int p = 0; p < costs.rows; ++p)
        {
            const hdp::CostVolume::Candidates own = volume.of(p);
            if (!own.interval.empty())
                std::copy(costs[p] + own.interval.first, costs[p] + own.interval.last + 1,
                          volume.costs.data() + own.start());
        }
    }

    Mat expected(const hdp::VolumePenalties& penalties) const
    {
        return oracle::volumeDisparity(costs, weights, intervals, penalties);
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
    for (bool isFull : { true, false })
        for (int numDisparities : { 7, 33, 64 })
        {
            SCOPED_TRACE(testing::Message() << numDisparities << " disparities, " << isFull);
            const Size size(27, 13);
            Layer layer(rng, size, numDisparities, 40, isFull);
            const Mat own = patchyIntervals(rng, size, numDisparities);
            hdp::excludeCandidates(own, layer.volume);
            for (int p = 0; p < size.area(); ++p)
                for (int d = 0; d < numDisparities; ++d)
                    if (d < own.ptr<Vec2w>()[p][0] || d > own.ptr<Vec2w>()[p][1])
                        layer.costs(p, d) = UCHAR_MAX;
            const Mat expected =
                oracle::volumeDisparity(layer.costs, layer.weights, layer.intervals, usualPenalties, own);
            expectIdentical(expected, layer.aggregate(usualPenalties, buffers));
        }
}

TEST(HDPStereo_VolumeScanlines, candidates_of_half_a_pixel)
{
    RNG rng(63);
    std::vector<short> buffers;
    for (bool isFull : { true, false })
    {
        Layer layer(rng, Size(19, 11), 33, 256, isFull);
        const Mat ofPixels = layer.expected(usualPenalties);
        layer.volume.steps = 2;
        Mat expected(ofPixels.size(), CV_16U);
        for (int p = 0; p < (int)expected.total(); ++p)
            expected.ptr<ushort>()[p] = (ushort)(ofPixels.ptr<ushort>()[p] / 2);
        expectIdentical(expected, layer.aggregate(usualPenalties, buffers));
    }
}

TEST(HDPStereo_VolumeScanlines, formula_for_candidates_of_each_pixel)
{
    RNG rng(67);
    std::vector<short> buffers;
    for (int numDisparities : { 1, 2, 3, 5, 16, 17, 40, 100 })
        for (int limit : { 3, 256 })
            for (int i = 0; i < 6; ++i)
            {
                SCOPED_TRACE(testing::Message() << numDisparities << " disparities, costs below " << limit);
                const Layer layer(rng, Size(23 + 20 * i, 19), numDisparities, limit, false);
                expectIdentical(layer.expected(usualPenalties), layer.aggregate(usualPenalties, buffers));
            }
}

//! Of the largest, sums must not overflow.
TEST(HDPStereo_VolumeScanlines, any_penalties)
{
    RNG rng(63);
    std::vector<short> buffers;
    const int largest = hdp::VolumePenalties::largest;
    for (int numDisparities : { 3, 33 })
    {
        const Layer layer(rng, Size(43, 38), numDisparities, 256, numDisparities == 3);
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
    const Layer layer(rng, Size(75, 61), 29, 256, false);
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
        const Layer layer(rng, size, numDisparities, 256, numDisparities == 16);
        const hdp::VolumePenalties penalties = { 30, 300, 1e9 };
        std::vector<short> sums(layer.volume.chunks * hdp::CostVolume::chunk);
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
