// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Vectors of bytes in groups of 16, one group for the candidates of a pixel; included by *.simd.hpp, once for each
// instruction set: no include guard. All operations stay inside the groups, so that a pixel's result does not depend on
// how many groups there are.

#if CV_AVX2

struct ByteLanes
{
    enum
    {
        groups = 2
    };
    __m256i v;

    static ByteLanes of(__m256i v)
    {
        const ByteLanes lanes = { v };
        return lanes;
    }
    static ByteLanes of(__m128i first, __m128i second)
    {
        return of(_mm256_inserti128_si256(_mm256_castsi128_si256(first), second, 1));
    }
    static ByteLanes repeat(int byte) { return of(_mm256_set1_epi8((char)byte)); }
    //! Byte `at`, one of the first 16
    template <int at> static ByteLanes repeatByte(const uchar* const* bytes)
    {
        return of(_mm256_shuffle_epi8(load(bytes, 0).v, _mm256_set1_epi8(at)));
    }
    static ByteLanes load(const uchar* bytes) { return of(_mm256_loadu_si256((const __m256i*)bytes)); }
    static ByteLanes load(const uchar* const* bytes, ptrdiff_t offset)
    {
        return of(_mm_loadu_si128((const __m128i*)(bytes[0] + offset)),
                  _mm_loadu_si128((const __m128i*)(bytes[1] + offset)));
    }
    static ByteLanes loadHalves(const uchar* const* low, const uchar* const* high, ptrdiff_t offset)
    {
        return of(halves(low[0] + offset, high[0] + offset), halves(low[1] + offset, high[1] + offset));
    }
    static __m128i halves(const uchar* low, const uchar* high)
    {
        return _mm_unpacklo_epi64(_mm_loadl_epi64((const __m128i*)low), _mm_loadl_epi64((const __m128i*)high));
    }
    //! The group at bytes, and 0, 1, .. 15 in the others
    static ByteLanes first(const uchar* bytes)
    {
        const __m128i identity = _mm_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
        return of(_mm_loadu_si128((const __m128i*)bytes), identity);
    }
    //! The group at bytes, then those of before but the last one.
    static ByteLanes shiftIn(const uchar* bytes, ByteLanes before)
    {
        return of(_mm256_inserti128_si256(_mm256_castsi128_si256(_mm_loadu_si128((const __m128i*)bytes)),
                                          _mm256_castsi256_si128(before.v), 1));
    }
    void store(uchar* bytes) const { _mm256_storeu_si256((__m256i*)bytes, v); }
    void storeLast(uchar* bytes) const { _mm_storeu_si128((__m128i*)bytes, _mm256_extracti128_si256(v, 1)); }

    ByteLanes operator&(ByteLanes b) const { return of(_mm256_and_si256(v, b.v)); }
    ByteLanes operator|(ByteLanes b) const { return of(_mm256_or_si256(v, b.v)); }
    ByteLanes operator^(ByteLanes b) const { return of(_mm256_xor_si256(v, b.v)); }
    ByteLanes operator+(ByteLanes b) const { return of(_mm256_adds_epu8(v, b.v)); } // saturated
    ByteLanes operator-(ByteLanes b) const { return of(_mm256_subs_epu8(v, b.v)); } // saturated
    ByteLanes max(ByteLanes b) const { return of(_mm256_max_epu8(v, b.v)); }
    ByteLanes min(ByteLanes b) const { return of(_mm256_min_epu8(v, b.v)); }
    ByteLanes quarter() const { return of(_mm256_and_si256(_mm256_srli_epi16(v, 2), _mm256_set1_epi8(63))); }
    //! Lane i receives lane i - 1, the first one 0.
    ByteLanes toNext() const { return of(_mm256_slli_si256(v, 1)); }
    //! Lane i receives lane i + 1, the last one 0.
    ByteLanes toPrevious() const { return of(_mm256_srli_si256(v, 1)); }
    //! Lane i receives lane order[i] of its group, or 0 if order[i] is 255.
    ByteLanes permute(ByteLanes order) const { return of(_mm256_shuffle_epi8(v, order.v)); }
    //! The smallest lane of each group, in all of its lanes.
    ByteLanes minimum() const
    {
        __m256i m = _mm256_min_epu8(v, _mm256_shuffle_epi32(v, 0x4e));
        m = _mm256_min_epu8(m, _mm256_shuffle_epi32(m, 0xb1));
        const __m256i words = _mm256_setr_epi8(2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13, 2, 3, 0, 1, 6, 7,
                                               4, 5, 10, 11, 8, 9, 14, 15, 12, 13);
        m = _mm256_min_epu8(m, _mm256_shuffle_epi8(m, words));
        const __m256i bytes = _mm256_setr_epi8(1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14, 1, 0, 3, 2, 5, 4,
                                               7, 6, 9, 8, 11, 10, 13, 12, 15, 14);
        return of(_mm256_min_epu8(m, _mm256_shuffle_epi8(m, bytes)));
    }
    ByteLanes countBits() const
    {
#if CV_AVX512_ICL
        return of(_mm256_popcnt_epi8(v));
#else
        const __m256i table = _mm256_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4, 0, 1, 1, 2, 1, 2, 2, 3,
                                               1, 2, 2, 3, 2, 3, 3, 4);
        const __m256i nibble = _mm256_set1_epi8(15);
        return of(_mm256_add_epi8(_mm256_shuffle_epi8(table, _mm256_and_si256(v, nibble)),
                                  _mm256_shuffle_epi8(table, _mm256_and_si256(_mm256_srli_epi16(v, 4), nibble))));
#endif
    }
    //! The first of the smallest lanes of each group.
    void findMinimum(unsigned* lanes) const
    {
        // Words of which the lane is the low byte
        const __m256i numbers = _mm256_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5,
                                                 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
        const __m256i words = _mm256_min_epu16(_mm256_unpacklo_epi8(numbers, v), _mm256_unpackhi_epi8(numbers, v));
        lanes[0] = _mm_extract_epi8(_mm_minpos_epu16(_mm256_castsi256_si128(words)), 0);
        lanes[1] = _mm_extract_epi8(_mm_minpos_epu16(_mm256_extracti128_si256(words, 1)), 0);
    }
};

#elif CV_SSE2

struct ByteLanes
{
    enum
    {
        groups = 1
    };
    __m128i v;

    static ByteLanes of(__m128i v)
    {
        const ByteLanes lanes = { v };
        return lanes;
    }
    static ByteLanes repeat(int byte) { return of(_mm_set1_epi8((char)byte)); }
    template <int at> static ByteLanes repeatByte(const uchar* const* bytes)
    {
        const __m128i all = _mm_loadu_si128((const __m128i*)bytes[0]);
        const __m128i twice = at < 8 ? _mm_unpacklo_epi8(all, all) : _mm_unpackhi_epi8(all, all);
        const __m128i fourTimes = at % 8 < 4 ? _mm_unpacklo_epi16(twice, twice) : _mm_unpackhi_epi16(twice, twice);
        return of(_mm_shuffle_epi32(fourTimes, at % 4 * 0x55));
    }
    static ByteLanes load(const uchar* bytes) { return of(_mm_loadu_si128((const __m128i*)bytes)); }
    static ByteLanes load(const uchar* const* bytes, ptrdiff_t offset) { return load(bytes[0] + offset); }
    static ByteLanes loadHalves(const uchar* const* low, const uchar* const* high, ptrdiff_t offset)
    {
        return of(_mm_unpacklo_epi64(_mm_loadl_epi64((const __m128i*)(low[0] + offset)),
                                     _mm_loadl_epi64((const __m128i*)(high[0] + offset))));
    }
    static ByteLanes first(const uchar* bytes) { return load(bytes); }
    static ByteLanes shiftIn(const uchar* bytes, ByteLanes) { return load(bytes); }
    void store(uchar* bytes) const { _mm_storeu_si128((__m128i*)bytes, v); }
    void storeLast(uchar* bytes) const { store(bytes); }

    ByteLanes operator&(ByteLanes b) const { return of(_mm_and_si128(v, b.v)); }
    ByteLanes operator|(ByteLanes b) const { return of(_mm_or_si128(v, b.v)); }
    ByteLanes operator^(ByteLanes b) const { return of(_mm_xor_si128(v, b.v)); }
    ByteLanes operator+(ByteLanes b) const { return of(_mm_adds_epu8(v, b.v)); }
    ByteLanes operator-(ByteLanes b) const { return of(_mm_subs_epu8(v, b.v)); }
    ByteLanes max(ByteLanes b) const { return of(_mm_max_epu8(v, b.v)); }
    ByteLanes min(ByteLanes b) const { return of(_mm_min_epu8(v, b.v)); }
    ByteLanes quarter() const { return of(_mm_and_si128(_mm_srli_epi16(v, 2), _mm_set1_epi8(63))); }
    ByteLanes toNext() const { return of(_mm_slli_si128(v, 1)); }
    ByteLanes toPrevious() const { return of(_mm_srli_si128(v, 1)); }
    ByteLanes permute(ByteLanes order) const
    {
        const __m128i identity = _mm_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
        if (_mm_movemask_epi8(_mm_cmpeq_epi8(order.v, identity)) == 0xffff) // most are
            return *this;
        uchar lanes[32], orders[16], permuted[16];
        store(lanes);
        _mm_storeu_si128((__m128i*)(lanes + 16), _mm_setzero_si128());
        order.store(orders);
        for (int i = 0; i < 16; ++i)
            permuted[i] = lanes[orders[i] & 31];
        return load(permuted);
    }
    ByteLanes minimum() const
    {
        __m128i m = _mm_min_epu8(v, _mm_shuffle_epi32(v, 0x4e));
        m = _mm_min_epu8(m, _mm_shuffle_epi32(m, 0xb1));
        m = _mm_min_epu8(m, _mm_shufflehi_epi16(_mm_shufflelo_epi16(m, 0xb1), 0xb1));
        return of(_mm_min_epu8(m, _mm_or_si128(_mm_slli_epi16(m, 8), _mm_srli_epi16(m, 8))));
    }
    ByteLanes countBits() const
    {
        const __m128i m1 = _mm_set1_epi8(0x55), m2 = _mm_set1_epi8(0x33), m4 = _mm_set1_epi8(0x0f);
        __m128i n = _mm_sub_epi8(v, _mm_and_si128(_mm_srli_epi16(v, 1), m1));
        n = _mm_add_epi8(_mm_and_si128(n, m2), _mm_and_si128(_mm_srli_epi16(n, 2), m2));
        return of(_mm_and_si128(_mm_add_epi8(n, _mm_srli_epi16(n, 4)), m4));
    }
    void findMinimum(unsigned* lanes) const
    {
        const int bits = _mm_movemask_epi8(_mm_cmpeq_epi8(v, minimum().v));
#if defined(__GNUC__)
        *lanes = (unsigned)__builtin_ctz(bits);
#else
        for (*lanes = 0; (bits >> *lanes & 1) == 0; ++*lanes)
        {
        }
#endif
    }
};

#else

struct ByteLanes
{
    enum
    {
        groups = 1
    };
    uchar v[16];

    template <class Operation> static ByteLanes each(const Operation& operation)
    {
        ByteLanes lanes;
        for (int i = 0; i < 16; ++i)
            lanes.v[i] = (uchar)operation(i);
        return lanes;
    }
    static ByteLanes repeat(int byte)
    {
        return each([=](int) { return byte; });
    }
    template <int at> static ByteLanes repeatByte(const uchar* const* bytes) { return repeat(bytes[0][at]); }
    static ByteLanes load(const uchar* bytes)
    {
        return each([=](int i) { return bytes[i]; });
    }
    static ByteLanes load(const uchar* const* bytes, ptrdiff_t offset) { return load(bytes[0] + offset); }
    static ByteLanes loadHalves(const uchar* const* low, const uchar* const* high, ptrdiff_t offset)
    {
        return each([=](int i) { return i < 8 ? low[0][offset + i] : high[0][offset + i - 8]; });
    }
    static ByteLanes first(const uchar* bytes) { return load(bytes); }
    static ByteLanes shiftIn(const uchar* bytes, const ByteLanes&) { return load(bytes); }
    void store(uchar* bytes) const { std::copy(v, v + 16, bytes); }
    void storeLast(uchar* bytes) const { store(bytes); }

    ByteLanes operator&(const ByteLanes& b) const
    {
        return each([&](int i) { return v[i] & b.v[i]; });
    }
    ByteLanes operator|(const ByteLanes& b) const
    {
        return each([&](int i) { return v[i] | b.v[i]; });
    }
    ByteLanes operator^(const ByteLanes& b) const
    {
        return each([&](int i) { return v[i] ^ b.v[i]; });
    }
    ByteLanes operator+(const ByteLanes& b) const
    {
        return each([&](int i) { return std::min(v[i] + b.v[i], 255); });
    }
    ByteLanes operator-(const ByteLanes& b) const
    {
        return each([&](int i) { return std::max(v[i] - b.v[i], 0); });
    }
    ByteLanes max(const ByteLanes& b) const
    {
        return each([&](int i) { return std::max(v[i], b.v[i]); });
    }
    ByteLanes min(const ByteLanes& b) const
    {
        return each([&](int i) { return std::min(v[i], b.v[i]); });
    }
    ByteLanes quarter() const
    {
        return each([&](int i) { return v[i] / 4; });
    }
    ByteLanes toNext() const
    {
        return each([&](int i) { return i > 0 ? v[i - 1] : 0; });
    }
    ByteLanes toPrevious() const
    {
        return each([&](int i) { return i < 15 ? v[i + 1] : 0; });
    }
    ByteLanes permute(const ByteLanes& order) const
    {
        return each([&](int i) { return order.v[i] < 16 ? v[order.v[i]] : 0; });
    }
    ByteLanes minimum() const { return repeat(*std::min_element(v, v + 16)); }
    ByteLanes countBits() const
    {
        return each([&](int i) {
            int bits = 0;
            for (int rest = v[i]; rest; rest &= rest - 1)
                ++bits;
            return bits;
        });
    }
    void findMinimum(unsigned* lanes) const { *lanes = (unsigned)(std::min_element(v, v + 16) - v); }
};

#endif
