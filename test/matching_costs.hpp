// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEST_MATCHING_COSTS_HPP
#define OPENCV_HDPSTEREO_TEST_MATCHING_COSTS_HPP

#include "test_precomp.hpp"
#include "../src/cost/matching_cost.hpp"

namespace opencv_test {

//! Expects the costs formula(y, x, candidate), for any number of lanes and any first candidate.
template <typename Formula>
void expectFormula(const hdp::MatchingCost& cost, const Formula& formula, Size size, int candidates, double tolerance)
{
    float costs[32];
    for (int lanes : { 4, 8, 16, 32 })
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                for (int first = 0; first < candidates; first += 3) // not multiples of lanes only
                {
                    const int pixel = y * size.width + x;
                    cost.evaluate(&pixel, 1, first, lanes, costs);
                    for (int k = 0; k < lanes && first + k < candidates; ++k)
                        ASSERT_NEAR(formula(y, x, first + k), costs[k], tolerance + 1e-6 * costs[k])
                            << lanes << " lanes, y " << y << " x " << x << " candidate " << first + k;
                }
}

//! Expects the same costs for many pixels at once, in any order and several times, as for one at a time.
inline void expectManyAtOnce(const hdp::MatchingCost& cost, Size size)
{
    RNG rng(35);
    std::vector<int> pixels(500);
    for (int& pixel : pixels)
        pixel = rng.uniform(0, size.area());
    for (int lanes : { 4, 8, 16, 32 })
    {
        std::vector<float> all(pixels.size() * lanes), one(lanes);
        cost.evaluate(pixels.data(), (int)pixels.size(), 5, lanes, all.data());
        for (size_t i = 0; i < pixels.size(); ++i)
        {
            cost.evaluate(&pixels[i], 1, 5, lanes, one.data());
            for (int k = 0; k < lanes; ++k)
                ASSERT_EQ(one[k], all[i * lanes + k]) << lanes << " lanes, pixel " << pixels[i];
        }
    }
}

} // namespace opencv_test

#endif
