// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set, as the *.simd.hpp that include it: no include guard.
#include "census_cost.hpp"
#include "../base/vectorized.hpp"
#include <cstring>
#include <type_traits>

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

namespace {

//! A byte in each of a word's; words are of as many bytes as there are candidates, up to 8.
template <typename Word> inline Word repeated(unsigned byte) { return (Word)-1 / 255 * byte; }

//! The number of bits set in each 4 bits
template <typename Word> inline Word countInNibbles(Word bits)
{
    bits -= (bits >> 1) & repeated<Word>(0x55);
    return (bits & repeated<Word>(0x33)) + ((bits >> 2) & repeated<Word>(0x33));
}

//! The number of bits set in each byte of 1 to 3 words
template <int count, typename Word> inline Word countInBytes(Word a, Word b, Word c)
{
    // Sum and carry of three bits: two counts instead of three
    const Word nibbles = count == 1   ? countInNibbles(a)
                         : count == 2 ? countInNibbles(a) + countInNibbles(b)
                                      : countInNibbles(a ^ b ^ c) + 2 * countInNibbles((a & b) | ((a ^ b) & c));
    return (nibbles & repeated<Word>(0x0f)) + ((nibbles >> 4) & repeated<Word>(0x0f));
}

//! Calls store(bits, number, position): so many costs in bits, those of pixel i from position i * lanes on.
template <int lanes, int count, typename Word, typename Store>
void evaluateCosts(const CensusPlanes& planes, const int* pixels, int size, int first, const Store& store)
{
    // Bits are counted in all words of a block at once, in order to fill vectors.
    const int block = lanes > 16 ? 1 : 32, words = lanes / (int)sizeof(Word);
    const double rowsPerPixel = 1. / planes.width;
    Word differences[count][block * words], bits[block * words];
    for (int begin = 0; begin < size; begin += block)
    {
        const int pixelCount = block == 1 ? 1 : std::min(block, size - begin);
        for (int i = 0; i < pixelCount; ++i)
        {
            const int p = pixels[begin + i], y = rowOf(p, rowsPerPixel), x = p - y * planes.width;
            const uchar* left = planes.left + y * planes.leftStep + 4 * x;
            const uchar* right = planes.right + y * planes.rightStep + (planes.width - 1 - x + first);
            for (int plane = 0; plane < count; ++plane, ++left, right += planes.rightPlane)
            {
                const Word pixel = repeated<Word>(*left);
                HDP_VECTORIZED for (int k = 0; k < words; ++k)
                {
                    Word candidates;
                    std::memcpy(&candidates, right + k * sizeof(Word), sizeof(Word));
                    differences[plane][i * words + k] = candidates ^ pixel;
                }
            }
        }
        HDP_VECTORIZED for (int k = 0; k < pixelCount * words; ++k) bits[k] = countInBytes<count>(
            differences[0][k], differences[count > 1 ? 1 : 0][k], differences[count > 2 ? 2 : 0][k]);
        store(reinterpret_cast<const uchar*>(bits), pixelCount * lanes, begin * lanes);
    }
}

template <int lanes, typename Store>
void evaluateCosts(const CensusPlanes& planes, const int* pixels, int size, int first, const Store& store)
{
    typedef typename std::conditional<lanes == 4, unsigned, uint64>::type Word;
    if (planes.count == 3)
        evaluateCosts<lanes, 3, Word>(planes, pixels, size, first, store);
    else if (planes.count == 2)
        evaluateCosts<lanes, 2, Word>(planes, pixels, size, first, store);
    else
        evaluateCosts<lanes, 1, Word>(planes, pixels, size, first, store);
}

} // namespace

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
