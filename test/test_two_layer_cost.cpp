// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "oracles.hpp"
#include "../src/cost/census_cost.hpp"

#include <numeric>

namespace opencv_test { namespace {

using hdp::CensusCost;
using hdp::TwoLayerCost;

//! The costs of all candidates of all pixels, asked for in any number of lanes
void expectCosts(const TwoLayerCost& cost, Size size, int candidates, const std::function<int(int, int, int)>& expected)
{
    std::vector<int> pixels(size.area());
    std::iota(pixels.begin(), pixels.end(), 0);
    for (int lanes : { 4, 8, 16, 32, 64 })
    {
        if (lanes > candidates + hdp::costPadding)
            continue;
        std::vector<uchar> costs(pixels.size() * lanes);
        for (int first = 0; first < candidates; first += lanes)
        {
            cost.evaluate(pixels.data(), (int)pixels.size(), first, lanes, costs.data());
            for (int p : pixels)
                for (int k = 0; k < std::min(lanes, candidates - first); ++k)
                    ASSERT_EQ(expected(p / size.width, p % size.width, first + k), costs[p * lanes + k])
                        << "pixel " << p << ", candidate " << first + k << ", lanes " << lanes;
        }
    }
}

//! Layers of even and odd sizes, in memory that held others before
TEST(HDPStereo_TwoLayerCost, definition_per_pixel)
{
    RNG rng(50);
    for (int blockSize : { 7, 5, 3 })
        for (const Size& finer : { Size(2, 2), Size(3, 5), Size(41, 13), Size(66, 8) })
            for (int candidates : { 1, 9, 40, 100 })
            {
                SCOPED_TRACE(testing::Message() << finer << ", candidates " << candidates << ", block " << blockSize);
                const Size size(finer.width / 2, finer.height / 2);
                const Mat left = randomImage(rng, size, CV_16UC1, 9), right = randomImage(rng, size, CV_16UC1, 9);
                const Mat leftBelow = randomImage(rng, finer, CV_16UC1, 9),
                          rightBelow = randomImage(rng, finer, CV_16UC1, 9);
                CensusCost own, below;
                own.prepare(left, right, candidates + 1, blockSize);
                below.prepare(leftBelow, rightBelow, 2 * candidates, blockSize, 1);
                const oracle::CensusCost ownFormula(left, right, blockSize);
                const oracle::CensusCost belowFormula(leftBelow, rightBelow, blockSize, 1);
                const TwoLayerCost both(own, &below), alone(own, nullptr);
                ASSERT_EQ(2, both.steps());
                expectCosts(both, size, 2 * candidates, [&](int y, int x, int h) {
                    double sum = 0;
                    for (int i = 0; i < 4; ++i)
                        sum += belowFormula(2 * y + i / 2, 2 * x + i % 2, h);
                    const double ofOwn = ownFormula(y, x, h / 2) + ownFormula(y, x, (h + 1) / 2);
                    return cvCeil(8 * (ofOwn / 8 + 3 * sum / 16));
                });
                ASSERT_EQ(1, alone.steps());
                expectCosts(alone, size, candidates, [&](int y, int x, int d) { return 8 * (int)ownFormula(y, x, d); });
            }
}

}} // namespace opencv_test
