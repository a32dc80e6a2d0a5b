// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "emulated_vectors.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/scanlines/scanline_aggregation.hpp"
#include "../src/scanlines/candidate_windows.hpp"
#include "../src/scanlines/scanline_aggregation.simd.hpp"

namespace opencv_test { namespace {

const int scale = 16;

//! A layer: grey levels, weights of edges, windows for them, and weights of smoothness in these
struct Layer
{
    Mat left, right, weights, windows, smoothness;
    int numDisparities, blockSize;
    hdp::PairMasks masks;

    //! Patches of texture at several disparities; the windows are predicted from about these, with outliers.
    Layer(RNG& rng, Size size, int numDisparities_, int blockSize_)
        : numDisparities(numDisparities_), blockSize(blockSize_)
    {
        left = randomImage(rng, size, CV_16UC1, 1021);
        right = randomImage(rng, size, CV_16UC1, 1021);
        weights = randomImage(rng, size, CV_8UC2, 256);
        Mat upper(std::max(size.height / 2, 1), std::max(size.width / 2, 1), CV_16UC1);
        const int largest = (numDisparities - 1) / 2;
        for (int y0 = 0; y0 < upper.rows; y0 += 10)
            for (int x0 = 0; x0 < upper.cols; x0 += 10)
            {
                const int d = rng.uniform(0, numDisparities);
                for (int y = y0; y < std::min(y0 + 10, upper.rows); ++y)
                    for (int x = x0; x < std::min(x0 + 10, upper.cols); ++x)
                    {
                        const int predicted = rng.uniform(0, 8) ? scale * d / 2 + rng.uniform(-12, 13)
                                                                : rng.uniform(0, scale * largest + 1);
                        upper.at<ushort>(y, x) = (ushort)std::min(std::max(predicted, 0), scale * largest);
                    }
                for (int y = 2 * y0; y < std::min(2 * y0 + 20, size.height); ++y)
                    for (int x = std::max(2 * x0, d); x < std::min(2 * x0 + 20, size.width); ++x)
                        if (rng.uniform(0, 10)) // noise
                            right.at<ushort>(y, x - d) = left.at<ushort>(y, x);
            }
        Mat others;
        hdp::findOtherSurfaces(upper, upper, others);
        hdp::predictWindows(upper, others, numDisparities, windows);
        smoothness.create(upper.size(), CV_8UC1);
        rng.fill(smoothness, RNG::UNIFORM, +hdp::SmoothnessWeight::min, hdp::SmoothnessWeight::max + 1);
    }

    //! Some pixels have no data, and some only a part of it.
    void mask(RNG& rng)
    {
        for (Mat* side : { &masks.left, &masks.right })
        {
            *side = Mat(size(), CV_8UC1);
            for (int y = 0; y < side->rows; ++y)
                for (int x = 0; x < side->cols; ++x)
                    side->at<uchar>(y, x) = (uchar)(rng.uniform(0, 3) ? 255 : rng.uniform(0, 256));
        }
    }

    Size size() const { return left.size(); }
    int largest() const { return scale * (numDisparities - 1); }

    hdp::CensusCost cost() const
    {
        hdp::CensusCost result;
        result.prepare(left, right, numDisparities, blockSize, 0, masks);
        return result;
    }

    //! Disparities beside residuals
    Mat expected(const hdp::ScanlinePenalties& penalties) const
    {
        Mat residual;
        const Mat disparity = oracle::Scanlines(left, right, weights, blockSize, numDisparities, largest(), windows,
                                                smoothness, penalties, masks)
                                  .match(residual);
        return beside(disparity, residual);
    }

    static Mat beside(const Mat& disparity, const Mat& residual)
    {
        Mat wide, both;
        residual.convertTo(wide, CV_16U);
        hconcat(disparity, wide, both);
        return both;
    }
};

Mat aggregate(const Layer& layer, const hdp::ScanlinePenalties& penalties, hdp::ScanlineBuffers& buffers)
{
    Mat disparity, residual;
    hdp::aggregateScanlines(layer.cost(), layer.weights, hdp::ImageFrame(layer.left.size()), layer.numDisparities,
                            layer.largest(), layer.windows, layer.smoothness, penalties, buffers, disparity, residual);
    return Layer::beside(disparity, residual);
}

const hdp::ScanlinePenalties usualPenalties = { 18, 60, 3, 7, 1, 1, 10 };

void expectFormula(const Layer& layer, const hdp::ScanlinePenalties& penalties, hdp::ScanlineBuffers& buffers)
{
    expectIdentical(layer.expected(penalties), aggregate(layer, penalties, buffers));
}

typedef testing::TestWithParam<int> HDPStereo_ScanlineAggregation; // blockSize

TEST_P(HDPStereo_ScanlineAggregation, formula_in_small_images)
{
    RNG rng(41);
    hdp::ScanlineBuffers buffers; // kept, as the matcher keeps them
    for (const Size& size : { Size(1, 1), Size(2, 1), Size(1, 2), Size(2, 2), Size(3, 3), Size(1, 9), Size(2, 9),
                              Size(3, 10), Size(50, 1), Size(51, 2), Size(50, 3), Size(44, 26), Size(45, 27) })
        for (int numDisparities : { 1, 2, 7, 15, 16, 17, 29, 70 })
        {
            SCOPED_TRACE(testing::Message() << size << ", " << numDisparities << " disparities");
            Layer layer(rng, size, numDisparities, GetParam());
            expectFormula(layer, usualPenalties, buffers);
            layer.mask(rng);
            expectFormula(layer, usualPenalties, buffers);
        }
}

TEST_P(HDPStereo_ScanlineAggregation, formula_in_stripes)
{
    RNG rng(42);
    hdp::ScanlineBuffers buffers;
    for (const Size& size :
         { Size(13, 255), Size(13, 256), Size(12, 257), Size(3, 301), Size(1, 387), Size(4, 390), Size(5, 401) })
        for (int numDisparities : { 9, 40 })
        {
            SCOPED_TRACE(testing::Message() << size << ", " << numDisparities << " disparities");
            const Layer layer(rng, size, numDisparities, GetParam());
            expectFormula(layer, usualPenalties, buffers);
        }
}

//! Also those that make sums of directions greater than a byte can hold
TEST_P(HDPStereo_ScanlineAggregation, any_penalties)
{
    RNG rng(43);
    hdp::ScanlineBuffers buffers;
    const hdp::ScanlinePenalties penalties[] = { { 0, 0, 3, 3, 1, 1, 0 },      { 0, 100, 5, 0, 2, 0, 255 },
                                                 { 100, 100, 8, 64, 4, 4, 0 }, { 5, 30, 0, 64, 2, 2, 1 },
                                                 { 1, 2, 3, 1, 3, 3, 100 },    { 60, 20, 4, 4, 1, 1, 5 },
                                                 { 0, 100, 64, 64, 1, 0, 0 } };
    for (int numDisparities : { 3, 14, 33 })
    {
        const Layer layer(rng, Size(61, 38), numDisparities, GetParam());
        for (const hdp::ScanlinePenalties& p : penalties)
        {
            SCOPED_TRACE(testing::Message()
                         << numDisparities << " disparities, " << p.small << ", " << p.large << ", " << p.edgeSlope
                         << ", " << p.borderSlope << ", " << p.prior << ", " << p.nearer << ", " << p.edgeNoise);
            expectFormula(layer, p, buffers);
        }
    }
}

TEST_P(HDPStereo_ScanlineAggregation, lanes_without_vectors)
{
    RNG rng(44);
    hdp::ScanlineBuffers buffers;
    hdp::ScanlineScratch scratch;
    for (const Size& size : { Size(1, 1), Size(2, 2), Size(37, 20), Size(40, 31) })
        for (int numDisparities : { 5, 16, 50 })
        {
            SCOPED_TRACE(testing::Message() << size << ", " << numDisparities << " disparities");
            Layer layer(rng, size, numDisparities, GetParam());
            if (numDisparities > 5)
                layer.mask(rng);
            const hdp::CensusCost cost = layer.cost();
            const float blunt = 52, sharp = 88;
            for (Mat* ofPairs : { &layer.windows, &layer.smoothness }) // as aggregateScanlines() does
                cv::copyMakeBorder(*ofPairs, *ofPairs, 0, 0, 0, (size.width + 1) / 2 - ofPairs->cols, BORDER_REPLICATE);
            const hdp::ScanlineProblem problem = {
                &cost,          &layer.weights,    size,           numDisparities, layer.largest(),
                &layer.windows, &layer.smoothness, usualPenalties, blunt,          sharp
            };
            const hdp::ScanlineStripe stripe = { Range(0, size.height), Range(0, size.height) };
            scratch.stored.create(size.height + 1, (int)hdp::ScanlineScratch::storedBytes(size.width), CV_8U);
            Mat disparity(size, CV_16UC1), residual(size, CV_8UC1);
            hdp::opt_emulated::aggregateStripe(problem, stripe, scratch, disparity, residual);
            expectIdentical(aggregate(layer, usualPenalties, buffers), Layer::beside(disparity, residual));
        }
}

INSTANTIATE_TEST_CASE_P(/**/, HDPStereo_ScanlineAggregation, testing::Values(3, 5, 7));

}} // namespace opencv_test
