// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "emulated_vectors.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/scanlines/range_scanlines.hpp"
#include "../src/scanlines/range_scanlines.simd.hpp"

namespace opencv_test { namespace {

const hdp::RangePenalties usualPenalties = { 18, 169, 35, 14, 3, 2 };

//! Patches of texture at several disparities, and what a layer above may have found
struct Layer : oracle::RangeLayer
{
    Layer(RNG& rng, Size size, int candidates_, int blockSize_)
    {
        blockSize = blockSize_;
        candidates = candidates_;
        const Size ofBelow(2 * size.width + (int)rng.uniform(0, 2), 2 * size.height + (int)rng.uniform(0, 2));
        left = randomImage(rng, ofBelow, CV_16UC1, 1021);
        right = randomImage(rng, ofBelow, CV_16UC1, 1021);
        upper = Mat(std::max(size.height / 2, 1), std::max(size.width / 2, 1), CV_16UC1);
        for (int y0 = 0; y0 < upper.rows; y0 += 5)
            for (int x0 = 0; x0 < upper.cols; x0 += 5)
            {
                const int d = rng.uniform(0, candidates);
                for (int y = y0; y < std::min(y0 + 5, upper.rows); ++y)
                    for (int x = x0; x < std::min(x0 + 5, upper.cols); ++x)
                        upper.at<ushort>(y, x) = (ushort)std::max(4 * d + rng.uniform(-9, 10), 0);
                for (int y = 4 * y0; y < std::min(4 * y0 + 20, left.rows); ++y)
                    for (int x = std::max(4 * x0, d); x < std::min(4 * x0 + 20, left.cols); ++x)
                        if (rng.uniform(0, 10)) // noise
                            right.at<ushort>(y, x - d) = left.at<ushort>(y, x);
            }
        weights = oracle::edgeWeights(patchyImage(rng, size, CV_8UC3));
    }

    //! Some pixels of the layer below have no data.
    void mask(RNG& rng)
    {
        masks.left = randomImage(rng, left.size(), CV_8UC1) > 80;
        masks.right = randomImage(rng, left.size(), CV_8UC1) > 80;
    }

    //! Rectangles that have few candidates, or none
    void restrict(RNG& rng)
    {
        intervals = Mat(weights.size(), CV_16UC2, Scalar(0, candidates - 1));
        for (int i = 0; i < 12; ++i)
        {
            const Point a(rng.uniform(0, weights.cols), rng.uniform(0, weights.rows));
            const Point b(rng.uniform(0, weights.cols), rng.uniform(0, weights.rows));
            const int first = rng.uniform(0, candidates), last = rng.uniform(first, candidates);
            intervals(Rect(a, b)).setTo(i % 4 == 3 ? Scalar(1, 0) : Scalar(first, last));
        }
    }

    hdp::CensusCost cost() const
    {
        hdp::CensusCost result;
        result.prepare(left, right, candidates, blockSize, 0, masks);
        return result;
    }

    Mat aggregate(const hdp::RangePenalties& penalties, hdp::RangeBuffers& buffers) const
    {
        Mat result;
        hdp::aggregateRange(cost(), hdp::ImageFrame(weights.size()), candidates, upper, weights, intervals, penalties,
                            buffers, result);
        return result;
    }

    std::vector<hdp::ScanlineStripe> wholeStripe() const
    {
        const hdp::ScanlineStripe whole = { Range(0, weights.rows), Range(0, weights.rows) };
        return std::vector<hdp::ScanlineStripe>(1, whole);
    }
};

void expectFormula(const Layer& layer, const hdp::RangePenalties& penalties, hdp::RangeBuffers& buffers)
{
    expectIdentical(layer.disparity(penalties, layer.wholeStripe()), layer.aggregate(penalties, buffers));
}

typedef testing::TestWithParam<int> HDPStereo_RangeScanlines; // blockSize

TEST_P(HDPStereo_RangeScanlines, formula_in_images_of_any_size)
{
    RNG rng(71);
    hdp::RangeBuffers buffers; // kept, as the matcher keeps them
    for (int height : { 1, 2, 3, 4, 5, 9, 21 })
        for (int width : { 1, 2, 3, 16, 33 })
        {
            SCOPED_TRACE(testing::Message() << width << " x " << height);
            const Layer layer(rng, Size(width, height), 16 + (5 * height + width) % 40, GetParam());
            expectFormula(layer, usualPenalties, buffers);
        }
}

TEST_P(HDPStereo_RangeScanlines, formula_for_any_number_of_candidates)
{
    RNG rng(72);
    hdp::RangeBuffers buffers;
    for (int candidates : { 1, 2, 3, 16, 31, 32, 33, 64, 65, 96, 120, 128, 129, 300 })
    {
        SCOPED_TRACE(testing::Message() << candidates << " candidates");
        expectFormula(Layer(rng, Size(41, 11), candidates, GetParam()), usualPenalties, buffers);
    }
}

TEST_P(HDPStereo_RangeScanlines, masks_and_intervals)
{
    RNG rng(73);
    hdp::RangeBuffers buffers;
    for (int candidates : { 17, 64, 100 })
    {
        SCOPED_TRACE(testing::Message() << candidates << " candidates");
        Layer layer(rng, Size(44, 19), candidates, GetParam());
        layer.mask(rng);
        expectFormula(layer, usualPenalties, buffers);
        layer.restrict(rng);
        expectFormula(layer, usualPenalties, buffers);
        layer.masks = hdp::PairMasks();
        expectFormula(layer, usualPenalties, buffers);
    }
}

//! Also those that make sums greater than a byte can hold
TEST_P(HDPStereo_RangeScanlines, any_penalties)
{
    RNG rng(74);
    hdp::RangeBuffers buffers;
    const hdp::RangePenalties penalties[] = {
        { 0, 0, 0, 14, 1, 0 }, { 0, 190, 1, 5, 1, 15 }, { 190, 190, 190, 1e9, 4, 3 }, { 10, 60, 10, 30, 2, 8 }
    };
    for (int i = 0; i < 4; ++i)
    {
        SCOPED_TRACE(i);
        expectFormula(Layer(rng, Size(37, 20), 48 + i, GetParam()), penalties[i], buffers);
    }
}

TEST_P(HDPStereo_RangeScanlines, formula_in_stripes)
{
    RNG rng(75);
    hdp::RangeBuffers buffers;
    for (const Size& size : { Size(13, 191), Size(9, 300), Size(3, 389) })
    {
        SCOPED_TRACE(testing::Message() << size);
        const Layer layer(rng, size, 24, GetParam());
        const auto stripes = hdp::stripesOf(hdp::ImageFrame(size), size.height, 96);
        ASSERT_LE(2u, stripes.size());
        expectIdentical(layer.disparity(usualPenalties, stripes), layer.aggregate(usualPenalties, buffers));
    }
}

TEST_P(HDPStereo_RangeScanlines, lanes_without_vectors)
{
    RNG rng(76);
    for (int candidates : { 16, 64, 70 })
    {
        SCOPED_TRACE(testing::Message() << candidates << " candidates");
        Layer layer(rng, Size(30, 14), candidates, GetParam());
        if (candidates > 16)
            layer.mask(rng);
        const hdp::CensusCost cost = layer.cost();
        hdp::RangeProblem problem = {
            cost, layer.weights.size(), candidates, layer.upper, layer.weights, layer.intervals, 0, {}, {}, {}
        };
        const hdp::RangePenalties penalties = { 18, 100, 100, 1e9, 3, 2 };
        problem.prepare(penalties);
        hdp::RangeScratch scratch;
        scratch.prepare(problem, layer.weights.rows);
        Mat disparity(layer.weights.size(), CV_16UC1);
        hdp::opt_emulated::aggregateRangeStripe(problem, layer.wholeStripe()[0], scratch, disparity);
        expectIdentical(layer.disparity(penalties, layer.wholeStripe()), disparity);
    }
}

INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_RangeScanlines, testing::Values(3, 5, 7));

}} // namespace opencv_test
