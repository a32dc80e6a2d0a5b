// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The vote at edges is tested with the vectors of the machine.
#include "emulated_vectors.hpp"
#include "helpers.hpp"
#include "../src/base/sixteen_words.simd.hpp"

namespace opencv_test { namespace {

typedef hdp::opt_emulated::SixteenWords Words;

//! Whether each lane of words is what the function says of its number. sum() tells them apart one by one.
template <class Expected> void expectLanes(const Words& words, const Expected& expected)
{
    for (int lane = 0; lane < 16; ++lane)
    {
        ushort one[16] = {};
        one[lane] = 1;
        const Words only = words.whereEqual(Words::load(one), Words::repeat(1));
        EXPECT_EQ((short)expected(lane), only.sum()) << "lane " << lane;
    }
}

TEST(HDPStereo_SixteenWords, operations)
{
    RNG rng(91);
    for (int i = 0; i < 50; ++i)
    {
        ushort a[16], b[16];
        uchar bytes[16];
        for (int k = 0; k < 16; ++k)
        {
            a[k] = (ushort)rng.uniform(0, i % 2 ? 65536 : 4);
            b[k] = (ushort)rng.uniform(0, i % 2 ? 65536 : 4);
            bytes[k] = (uchar)rng.uniform(0, 256);
        }
        const Words first = Words::load(a), second = Words::load(b);
        expectLanes(first, [&](int k) { return a[k]; });
        expectLanes(Words::load(bytes), [&](int k) { return bytes[k]; });
        expectLanes(Words::repeat(a[0]), [&](int) { return a[0]; });
        expectLanes(first.max(second), [&](int k) { return std::max(a[k], b[k]); });
        expectLanes(first.min(second), [&](int k) { return std::min(a[k], b[k]); });
        expectLanes(first.difference(second), [&](int k) { return std::abs(a[k] - b[k]); });
        expectLanes(first + second, [&](int k) { return a[k] + b[k]; });
        expectLanes(first - second, [&](int k) { return a[k] - b[k]; });
        expectLanes(first.whereNotGreater(first, second, second), [&](int k) { return std::min(a[k], b[k]); });
        expectLanes(first.whereNotGreater(second, first, second), [&](int k) { return std::max(a[k], b[k]); });
        EXPECT_EQ(*std::min_element(a, a + 16), first.minimum());
        short stored[16];
        first.store(stored);
        expectLanes(first, [&](int k) { return stored[k]; });
        expectLanes(Words::load(stored), [&](int k) { return a[k]; });
        expectLanes(first.whereEqual(first, second), [&](int k) { return a[k] == b[k] ? a[k] : 0; });
    }
}

TEST(HDPStereo_SixteenWords, sum_of_negative_ones)
{
    ushort words[16];
    int sum = 0;
    for (int k = 0; k < 16; ++k)
    {
        const int word = k % 3 ? -1620 : 1500;
        words[k] = (ushort)word;
        sum += word;
    }
    EXPECT_EQ(sum, Words::load(words).sum());
}

}} // namespace opencv_test
