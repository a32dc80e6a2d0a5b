// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Compiled once for each instruction set, as the *.simd.hpp that include it: no include guard.
#include "byte_lanes.simd.hpp"
#include "vectorized.hpp"

namespace cv { namespace stereo { namespace hdp {
CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN

//! 16 unsigned words, in one vector or two, under names that all versions of OpenCV have in common. Those that short
//! stands for are not negative.
struct SixteenWords
{
    static const int count = 16;
#if HDP_LANES_AVX2
    typedef v_uint16x16 Vector;
    static const int parts = 1;
    static Vector all(int word) { return v256_setall_u16((ushort)word); }
    static Vector loadPart(const ushort* words) { return v256_load(words); }
    static Vector loadPart(const short* words) { return v_reinterpret_as_u16(v256_load(words)); }
    static Vector loadPart(const uchar* bytes) { return v256_load_expand(bytes); }
#else
    typedef v_uint16x8 Vector;
    static const int parts = 2;
    static Vector all(int word) { return v_setall_u16((ushort)word); }
    static Vector loadPart(const ushort* words) { return v_load(words); }
    static Vector loadPart(const short* words) { return v_reinterpret_as_u16(v_load(words)); }
    static Vector loadPart(const uchar* bytes) { return v_load_expand(bytes); }
#endif
    Vector v[parts];

    SixteenWords() {}

    static SixteenWords repeat(int word)
    {
        return of([=](int) { return all(word); });
    }
    //! Of words or bytes
    template <typename T> static SixteenWords load(const T* from)
    {
        return of([=](int i) { return loadPart(from + i * count / parts); });
    }
    void store(short* words) const
    {
        HDP_UNROLLED for (int i = 0; i < parts; ++i) v_store(words + i * count / parts, v_reinterpret_as_s16(v[i]));
    }

    SixteenWords max(const SixteenWords& b) const { return with<v_max>(b); }
    SixteenWords min(const SixteenWords& b) const { return with<v_min>(b); }
    SixteenWords difference(const SixteenWords& b) const { return with<v_absdiff>(b); } // its absolute value

    // Modulo 2^16
    SixteenWords operator+(const SixteenWords& b) const { return with<v_add_wrap>(b); }
    SixteenWords operator-(const SixteenWords& b) const { return with<v_sub_wrap>(b); }

    //! Its own lanes where those of a and b are the same, 0 elsewhere
    SixteenWords whereEqual(const SixteenWords& a, const SixteenWords& b) const
    {
        return of([&](int i) { return v_select(equal(a.v[i], b.v[i]), v[i], all(0)); });
    }

    //! Its own lanes where those of a are not greater than those of b, others elsewhere
    SixteenWords whereNotGreater(const SixteenWords& a, const SixteenWords& b, const SixteenWords& others) const
    {
        return of([&](int i) { return v_select(equal(v_max(a.v[i], b.v[i]), b.v[i]), v[i], others.v[i]); });
    }

    //! The lowest lane
    int minimum() const
    {
        const Vector least = v_min(v[0], v[parts - 1]);
#if HDP_LANES_AVX2
        const __m128i half = _mm_min_epu16(_mm256_castsi256_si128(least.val), _mm256_extracti128_si256(least.val, 1));
        return _mm_cvtsi128_si32(_mm_minpos_epu16(half)) & 0xffff;
#elif HDP_LANES_SSE4
        return _mm_cvtsi128_si32(_mm_minpos_epu16(least.val)) & 0xffff;
#else
        return v_reduce_min(least);
#endif
    }

    //! The sum of all lanes, read as signed numbers; it must fit into 16 bits itself.
    int sum() const
    {
        int result = 0;
        for (int i = 0; i < parts; ++i)
            result += v_reduce_sum(v_reinterpret_as_s16(v[i]));
        return result;
    }

private:
    template <class Part> static CV_ALWAYS_INLINE SixteenWords of(const Part& part)
    {
        SixteenWords result;
        HDP_UNROLLED for (int i = 0; i < parts; ++i) result.v[i] = part(i);
        return result;
    }
    template <Vector operation(const Vector&, const Vector&)>
    CV_ALWAYS_INLINE SixteenWords with(const SixteenWords& b) const
    {
        return of([&](int i) { return operation(v[i], b.v[i]); });
    }

#if CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 9
    static Vector equal(const Vector& a, const Vector& b) { return a == b; }
#else
    static Vector equal(const Vector& a, const Vector& b) { return v_eq(a, b); }
#endif
};

CV_CPU_OPTIMIZATION_NAMESPACE_END
}}} // namespace cv::stereo::hdp
