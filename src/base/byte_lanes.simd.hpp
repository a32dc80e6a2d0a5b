// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set, as the *.simd.hpp that include it: no include guard.

#if CV_RVV && !defined(CV_FORCE_SIMD128_CPP) // its vectors have no size that the compiler knows
#define CV_FORCE_SIMD128_CPP
#endif
#include "opencv2/core/hal/intrin.hpp"

// Which instructions may stand beside the universal intrinsics: none if these are OpenCV's emulation.
#define HDP_LANES_AVX2 (CV_AVX2 && !CV_SIMD128_CPP)
#define HDP_LANES_SSE2 (CV_SSE2 && !CV_AVX2 && !CV_SIMD128_CPP)
#define HDP_LANES_SSE4 (HDP_LANES_SSE2 && CV_SSE4_2)
#define HDP_LANES_WASM (CV_WASM_SIMD && !CV_SIMD128_CPP)
#if CV_NEON && !CV_SIMD128_CPP && (defined(__aarch64__) || defined(_M_ARM64))
#define HDP_LANES_NEON 1
#else
#define HDP_LANES_NEON 0
#endif

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

/** A vector of bytes in groups of 16, each for the candidates of one pixel. Every operation stays inside the groups, so
the result for a pixel does not depend on the number of groups.

It is OpenCV's universal intrinsics, under operators that all versions of OpenCV have in common, and what they lack:
shuffles inside a group, and the minimum of each group. These are written for AVX2, SSE4.2, SSE2, 64-bit NEON and
WebAssembly; the last branch of each is for all others, OpenCV's emulation without vectors among them. */
struct ByteLanes
{
#if HDP_LANES_AVX2
    typedef v_uint8x32 Vector;
    static const int groups = 2;
#else
    typedef v_uint8x16 Vector;
    static const int groups = 1;
#endif
    Vector v;

    ByteLanes() {}
    ByteLanes(const Vector& vector) : v(vector) {}

#if HDP_LANES_AVX2
    ByteLanes(const __m256i& vector) : v(vector) {}
    ByteLanes(const v_uint8x16& first, const v_uint8x16& second)
        : v(_mm256_inserti128_si256(_mm256_castsi128_si256(first.val), second.val, 1))
    {
    }
    static CV_ALWAYS_INLINE ByteLanes repeat(int byte) { return v256_setall_u8((uchar)byte); }
    static CV_ALWAYS_INLINE ByteLanes load(const uchar* bytes) { return v256_load(bytes); }
    static CV_ALWAYS_INLINE ByteLanes load(const uchar* const* bytes, ptrdiff_t offset)
    {
        return ByteLanes(v_load(bytes[0] + offset), v_load(bytes[1] + offset));
    }
    static CV_ALWAYS_INLINE ByteLanes loadHalves(const uchar* const* low, const uchar* const* high, ptrdiff_t offset)
    {
        return ByteLanes(v_load_halves(low[0] + offset, high[0] + offset),
                         v_load_halves(low[1] + offset, high[1] + offset));
    }
    //! An order for permute() that changes the first or the last group alone, as bytes say; the other one has 0 .. 15.
    static CV_ALWAYS_INLINE ByteLanes orderOfFirst(const uchar* bytes)
    {
        return ByteLanes(v_load(bytes), laneNumbers());
    }
    static CV_ALWAYS_INLINE ByteLanes orderOfLast(const uchar* bytes)
    {
        return ByteLanes(laneNumbers(), v_load(bytes));
    }
    //! The group at bytes, then the first one of before
    static CV_ALWAYS_INLINE ByteLanes shiftInFirst(const uchar* bytes, const ByteLanes& before)
    {
        return ByteLanes(v_load(bytes), v_uint8x16(_mm256_castsi256_si128(before.v.val)));
    }
    //! The last group of before, then that at bytes
    static CV_ALWAYS_INLINE ByteLanes shiftInLast(const ByteLanes& before, const uchar* bytes)
    {
        return ByteLanes(v_uint8x16(_mm256_extracti128_si256(before.v.val, 1)), v_load(bytes));
    }
    CV_ALWAYS_INLINE void storeFirst(uchar* bytes) const { v_store_low(bytes, v); }
    CV_ALWAYS_INLINE void storeLast(uchar* bytes) const { v_store_high(bytes, v); }
#else
    static CV_ALWAYS_INLINE ByteLanes repeat(int byte) { return v_setall_u8((uchar)byte); }
    static CV_ALWAYS_INLINE ByteLanes load(const uchar* bytes) { return v_load(bytes); }
    static CV_ALWAYS_INLINE ByteLanes load(const uchar* const* bytes, ptrdiff_t offset)
    {
        return v_load(bytes[0] + offset);
    }
    static CV_ALWAYS_INLINE ByteLanes loadHalves(const uchar* const* low, const uchar* const* high, ptrdiff_t offset)
    {
        return v_load_halves(low[0] + offset, high[0] + offset);
    }
    static CV_ALWAYS_INLINE ByteLanes orderOfFirst(const uchar* bytes) { return v_load(bytes); }
    static CV_ALWAYS_INLINE ByteLanes orderOfLast(const uchar* bytes) { return v_load(bytes); }
    static CV_ALWAYS_INLINE ByteLanes shiftInFirst(const uchar* bytes, const ByteLanes&) { return v_load(bytes); }
    static CV_ALWAYS_INLINE ByteLanes shiftInLast(const ByteLanes&, const uchar* bytes) { return v_load(bytes); }
    CV_ALWAYS_INLINE void storeFirst(uchar* bytes) const { v_store(bytes, v); }
    CV_ALWAYS_INLINE void storeLast(uchar* bytes) const { v_store(bytes, v); }
#endif
    CV_ALWAYS_INLINE void store(uchar* bytes) const { v_store(bytes, v); }

    static CV_ALWAYS_INLINE v_uint8x16 laneNumbers()
    {
        static const uchar numbers[] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15 };
        return v_load(numbers);
    }

    // Sums and differences are saturated.
#if CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 9 // operators; all later versions have functions
    CV_ALWAYS_INLINE ByteLanes operator+(const ByteLanes& b) const { return v + b.v; }
    CV_ALWAYS_INLINE ByteLanes operator-(const ByteLanes& b) const { return v - b.v; }
    CV_ALWAYS_INLINE ByteLanes operator&(const ByteLanes& b) const { return v & b.v; }
    CV_ALWAYS_INLINE ByteLanes operator|(const ByteLanes& b) const { return v | b.v; }
    CV_ALWAYS_INLINE ByteLanes operator^(const ByteLanes& b) const { return v ^ b.v; }
    CV_ALWAYS_INLINE Vector equals(const ByteLanes& b) const { return v == b.v; }
#else
    CV_ALWAYS_INLINE ByteLanes operator+(const ByteLanes& b) const { return v_add(v, b.v); }
    CV_ALWAYS_INLINE ByteLanes operator-(const ByteLanes& b) const { return v_sub(v, b.v); }
    CV_ALWAYS_INLINE ByteLanes operator&(const ByteLanes& b) const { return v_and(v, b.v); }
    CV_ALWAYS_INLINE ByteLanes operator|(const ByteLanes& b) const { return v_or(v, b.v); }
    CV_ALWAYS_INLINE ByteLanes operator^(const ByteLanes& b) const { return v_xor(v, b.v); }
    CV_ALWAYS_INLINE Vector equals(const ByteLanes& b) const { return v_eq(v, b.v); }
#endif
    CV_ALWAYS_INLINE ByteLanes max(const ByteLanes& b) const { return v_max(v, b.v); }
    CV_ALWAYS_INLINE ByteLanes min(const ByteLanes& b) const { return v_min(v, b.v); }
    CV_ALWAYS_INLINE ByteLanes difference(const ByteLanes& b) const { return v_absdiff(v, b.v); } // its absolute value

    //! Each lane divided by 2^bits, rounded down
    template <int bits> CV_ALWAYS_INLINE ByteLanes shiftedRight() const
    {
#if HDP_LANES_NEON
        return Vector(vshrq_n_u8(v.val, bits));
#else
        return ByteLanes(v_reinterpret_as_u8(v_shr<bits>(v_reinterpret_as_u16(v)))) & repeat(255 >> bits);
#endif
    }

    //! The number of bits that are set in each lane
    CV_ALWAYS_INLINE ByteLanes countBits() const
    {
#if HDP_LANES_AVX2 && CV_AVX512_ICL
        return _mm256_popcnt_epi8(v.val);
#elif HDP_LANES_SSE4
        const __m128i counts = _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4), low = _mm_set1_epi8(15);
        return Vector(_mm_add_epi8(_mm_shuffle_epi8(counts, _mm_and_si128(v.val, low)),
                                   _mm_shuffle_epi8(counts, _mm_and_si128(_mm_srli_epi16(v.val, 4), low))));
#elif HDP_LANES_WASM
        return Vector(wasm_i8x16_popcnt(v.val));
#else
        return v_popcount(v);
#endif
    }

    //! The same of three together. Without an instruction for it, their sums and carries take two counts, not three.
    static CV_ALWAYS_INLINE ByteLanes countBits(const ByteLanes& a, const ByteLanes& b, const ByteLanes& c)
    {
#if HDP_LANES_NEON || HDP_LANES_WASM
        return a.countBits() + b.countBits() + c.countBits();
#else
        const ByteLanes difference = a ^ b, carries = ((a & b) | (difference & c)).countBits();
        return (difference ^ c).countBits() + (carries + carries);
#endif
    }

    //! The byte in place `at`, of the first 16, in all lanes of its group
    template <int at> static CV_ALWAYS_INLINE ByteLanes repeatByte(const uchar* const* bytes)
    {
#if HDP_LANES_AVX2
        return _mm256_shuffle_epi8(load(bytes, 0).v.val, _mm256_set1_epi8(at));
#elif HDP_LANES_SSE4
        return Vector(_mm_shuffle_epi8(v_load(bytes[0]).val, _mm_set1_epi8(at)));
#elif HDP_LANES_SSE2
        const __m128i all = v_load(bytes[0]).val;
        const __m128i twice = at < 8 ? _mm_unpacklo_epi8(all, all) : _mm_unpackhi_epi8(all, all);
        const __m128i fourTimes = at % 8 < 4 ? _mm_unpacklo_epi16(twice, twice) : _mm_unpackhi_epi16(twice, twice);
        return Vector(_mm_shuffle_epi32(fourTimes, at % 4 * 0x55));
#elif HDP_LANES_NEON
        return Vector(vdupq_laneq_u8(v_load(bytes[0]).val, at));
#else
        return repeat(bytes[0][at]);
#endif
    }

    //! The byte in place `at` of 16, in all lanes of all groups
    template <int at> static CV_ALWAYS_INLINE ByteLanes repeatByte(const uchar* bytes)
    {
#if HDP_LANES_AVX2
        return _mm256_shuffle_epi8(_mm256_broadcastsi128_si256(v_load(bytes).val), _mm256_set1_epi8(at));
#else
        return repeatByte<at>(&bytes);
#endif
    }

    //! Lane i of a group receives lane i - 1, the first one 0.
    CV_ALWAYS_INLINE ByteLanes toNext() const
    {
#if HDP_LANES_AVX2
        return _mm256_slli_si256(v.val, 1);
#else
        return v_rotate_left<1>(v);
#endif
    }

    //! Lane i of a group receives lane i + 1, the last one 0.
    CV_ALWAYS_INLINE ByteLanes toPrevious() const
    {
#if HDP_LANES_AVX2
        return _mm256_srli_si256(v.val, 1);
#else
        return v_rotate_right<1>(v);
#endif
    }

    //! Lane i of all receives the sum of lanes floor(i / 2) and ceil(i / 2).
    CV_ALWAYS_INLINE ByteLanes sumsOfHalves() const
    {
#if HDP_LANES_AVX2
        const __m256i last = _mm256_permute2x128_si256(v.val, v.val, 0x11);
        const __m256i next = _mm256_alignr_epi8(last, v.val, 1);
        // The first eight in one half, the eight behind them in the other one
        const __m256i floors = _mm256_permute4x64_epi64(v.val, 0x10), ceils = _mm256_permute4x64_epi64(next, 0x10);
        return ByteLanes(_mm256_unpacklo_epi8(floors, floors)) + ByteLanes(_mm256_unpacklo_epi8(floors, ceils));
#else
        v_uint8x16 both, high, beside;
        v_zip(v, v, both, high);
        v_zip(v, toPrevious().v, beside, high);
        return ByteLanes(both) + ByteLanes(beside);
#endif
    }

    //! Lane i of a group receives its lane order[i], or 0 if order[i] is 255.
    CV_ALWAYS_INLINE ByteLanes permute(const ByteLanes& order) const
    {
#if HDP_LANES_AVX2
        return _mm256_shuffle_epi8(v.val, order.v.val);
#elif HDP_LANES_SSE4
        return Vector(_mm_shuffle_epi8(v.val, order.v.val));
#elif HDP_LANES_NEON
        return Vector(vqtbl1q_u8(v.val, order.v.val));
#elif HDP_LANES_WASM
        return Vector(wasm_i8x16_swizzle(v.val, order.v.val));
#else
        if (v_check_all(order.equals(laneNumbers()))) // as it is for most pixels
            return *this;
        uchar lanes[32], orders[16], permuted[16];
        store(lanes);
        repeat(0).store(lanes + 16);
        (order & repeat(31)).store(orders);
        for (int i = 0; i < 16; ++i)
            permuted[i] = lanes[orders[i]];
        return load(permuted);
#endif
    }

    //! The smallest lane of each group, in all of its lanes
    CV_ALWAYS_INLINE ByteLanes minimum() const
    {
#if HDP_LANES_AVX2
        __m256i m = _mm256_min_epu8(v.val, _mm256_shuffle_epi32(v.val, 0x4e));
        m = _mm256_min_epu8(m, _mm256_shuffle_epi32(m, 0xb1));
        const __m256i words = _mm256_setr_epi8(2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13, 2, 3, 0, 1, 6, 7,
                                               4, 5, 10, 11, 8, 9, 14, 15, 12, 13);
        m = _mm256_min_epu8(m, _mm256_shuffle_epi8(m, words));
        const __m256i bytes = _mm256_setr_epi8(1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14, 1, 0, 3, 2, 5, 4,
                                               7, 6, 9, 8, 11, 10, 13, 12, 15, 14);
        return _mm256_min_epu8(m, _mm256_shuffle_epi8(m, bytes));
#elif HDP_LANES_SSE4
        const __m128i words = _mm_min_epu8(v.val, _mm_srli_epi16(v.val, 8)); // of pairs
        return Vector(_mm_shuffle_epi8(_mm_minpos_epu16(words), _mm_setzero_si128()));
#elif HDP_LANES_SSE2
        __m128i m = _mm_min_epu8(v.val, _mm_shuffle_epi32(v.val, 0x4e));
        m = _mm_min_epu8(m, _mm_shuffle_epi32(m, 0xb1));
        m = _mm_min_epu8(m, _mm_shufflehi_epi16(_mm_shufflelo_epi16(m, 0xb1), 0xb1));
        return Vector(_mm_min_epu8(m, _mm_or_si128(_mm_slli_epi16(m, 8), _mm_srli_epi16(m, 8))));
#elif HDP_LANES_NEON
        return Vector(vdupq_n_u8(vminvq_u8(v.val)));
#elif HDP_LANES_WASM
        v128_t m = wasm_u8x16_min(v.val, wasm_i64x2_shuffle(v.val, v.val, 1, 0));
        m = wasm_u8x16_min(m, wasm_i32x4_shuffle(m, m, 1, 0, 3, 2));
        m = wasm_u8x16_min(m, wasm_i16x8_shuffle(m, m, 1, 0, 3, 2, 5, 4, 7, 6));
        return Vector(
            wasm_u8x16_min(m, wasm_i8x16_shuffle(m, m, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14)));
#else
        return repeat(v_reduce_min(v));
#endif
    }

    //! The smallest lane of all, in all lanes
    CV_ALWAYS_INLINE ByteLanes minimumOfAll() const
    {
#if HDP_LANES_AVX2
        const __m128i half = _mm_min_epu8(_mm256_castsi256_si128(v.val), _mm256_extracti128_si256(v.val, 1));
        return _mm256_broadcastb_epi8(_mm_minpos_epu16(_mm_min_epu8(half, _mm_srli_epi16(half, 8))));
#else
        return minimum();
#endif
    }

    //! The first lane that is that of b; -1 if there is none
    CV_ALWAYS_INLINE int firstEqual(const ByteLanes& b) const
    {
        const Vector isEqual = equals(b);
#if HDP_LANES_NEON && defined(__GNUC__)
        const uint8x8_t halves = vshrn_n_u16(vreinterpretq_u16_u8(isEqual.val), 4); // of each lane, in order
        const uint64_t mask = vget_lane_u64(vreinterpret_u64_u8(halves), 0);
        return mask ? __builtin_ctzll(mask) / 4 : -1;
#else
        return v_check_any(isEqual) ? v_scan_forward(isEqual) : -1;
#endif
    }

    //! The first of the smallest lanes of each group
    CV_ALWAYS_INLINE void findMinimum(unsigned* lanes) const
    {
#if HDP_LANES_AVX2
        // Words of which the lane is the low byte
        const __m256i numbers = ByteLanes(laneNumbers(), laneNumbers()).v.val;
        const __m256i words =
            _mm256_min_epu16(_mm256_unpacklo_epi8(numbers, v.val), _mm256_unpackhi_epi8(numbers, v.val));
        lanes[0] = _mm_extract_epi8(_mm_minpos_epu16(_mm256_castsi256_si128(words)), 0);
        lanes[1] = _mm_extract_epi8(_mm_minpos_epu16(_mm256_extracti128_si256(words, 1)), 0);
#elif HDP_LANES_SSE4
        const __m128i numbers = laneNumbers().val;
        const __m128i words = _mm_min_epu16(_mm_unpacklo_epi8(numbers, v.val), _mm_unpackhi_epi8(numbers, v.val));
        lanes[0] = _mm_extract_epi8(_mm_minpos_epu16(words), 0);
#elif HDP_LANES_NEON
        lanes[0] = vminvq_u8(vornq_u8(laneNumbers().val, equals(minimum()).val));
#elif HDP_LANES_WASM
        lanes[0] = (unsigned)__builtin_ctz(wasm_i8x16_bitmask(equals(minimum()).val));
#else
        lanes[0] = (unsigned)v_scan_forward(equals(minimum()));
#endif
    }
};

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
