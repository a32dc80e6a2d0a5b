// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEST_SYNTHETIC_PAIR_HPP
#define OPENCV_HDPSTEREO_TEST_SYNTHETIC_PAIR_HPP

#include "test_precomp.hpp"

namespace opencv_test {

/** A stereo pair with exact truth: slanted textured planes, with areas without texture, behind an ellipse,
a slanted board and a thin pole, with independent noise in both images. Only integer random numbers and + - * / go
into it, so that a seed gives the same pair on every machine. */
struct SyntheticPair
{
    Mat left, right; // CV_8UC3
    Mat truth;       // CV_32FC1: the disparity of each left pixel, in [0, 0.9 * numDisparities]
    Mat visible;     // CV_8UC1: 255 where the right image shows the same point
};

class SyntheticScene
{
public:
    SyntheticScene(Size size, int numDisparities, int seed, bool planeOnly) : size_(size), rng_((uint64)seed + 1)
    {
        CV_Assert(size.width >= 2 * numDisparities);
        const double w = size.width, h = size.height, n = numDisparities;
        // Disparities across x and y (in pixels), from the back to the front
        addSurface(0.10 * n, 0.12 * n / w, 0.08 * n / h, WHOLE, 0, 0, 0, 0, 60);
        if (planeOnly)
            return;
        // Never two random numbers in one call: compilers differ in the order in which they evaluate arguments.
        double cy = jitter(0.72) * h, cx = jitter(0.20) * w;
        addSurface(0.30 * n, 0.15 * n / w, 0, BOX, cx, cy, 0.17 * w, 0.20 * h, 40);
        cy = jitter(0.34) * h, cx = jitter(0.38) * w;
        addSurface(0.45 * n, 0, 0, ELLIPSE, cx, cy, 0.12 * w, 0.20 * h, 50);
        cy = jitter(0.60) * h, cx = jitter(0.70) * w;
        addSurface(0.45 * n, 0.10 * n / w, 0.25 * n / h, BOX, cx, cy, 0.14 * w, 0.24 * h, 45);
        addSurface(0.75 * n, 0, 0, BOX, jitter(0.52) * w, 0.5 * h, 0.02 * w, 0.5 * h, 40);
    }

    SyntheticPair render()
    {
        SyntheticPair pair;
        pair.left.create(size_, CV_8UC3);
        pair.right.create(size_, CV_8UC3);
        pair.truth.create(size_, CV_32F);
        pair.visible.create(size_, CV_8U);
        for (int y = 0; y < size_.height; ++y)
            for (int x = 0; x < size_.width; ++x)
            {
                const Hit left = look(x, y, false), right = look(x, y, true);
                pair.left.at<Vec3b>(y, x) = color(left, y);
                pair.right.at<Vec3b>(y, x) = color(right, y);
                pair.truth.at<float>(y, x) = (float)left.disparity;
                const double matched = x - left.disparity;
                const bool inside = matched >= 0 && matched <= size_.width - 1;
                pair.visible.at<uchar>(y, x) = inside && look(matched, y, true).surface == left.surface ? 255 : 0;
            }
        return pair;
    }

private:
    enum Shape
    {
        WHOLE,
        BOX,
        ELLIPSE
    };

    struct Surface
    {
        double offset, slopeX, slopeY; // disparity = offset + slopeX * x + slopeY * y, x in the left image
        Shape shape;
        double centerX, centerY, radiusX, radiusY;
        int contrast;
        Vec3i base;
        Mat fine, coarse; // CV_8UC3 noise, one value per pixel and one per 8 x 8 pixels

        bool covers(double x, double y) const
        {
            const double u = shape == WHOLE ? 0 : (x - centerX) / radiusX,
                         v = shape == WHOLE ? 0 : (y - centerY) / radiusY;
            return shape == ELLIPSE ? u * u + v * v <= 1 : std::abs(u) <= 1 && std::abs(v) <= 1;
        }

        //! The left side of a box and a corner of the background have no texture.
        bool isTextured(double x, double y, Size size) const
        {
            const bool isCorner = x > 0.85 * size.width && y < 0.15 * size.height;
            return shape == ELLIPSE ||
                   (shape == BOX ? radiusX < radiusY / 2 || x > centerX - 0.6 * radiusX : !isCorner);
        }
    };

    struct Hit
    {
        int surface;
        double x, disparity; // column in the left image
    };

    double jitter(double center) { return center + rng_.uniform(-30, 31) / 1000.; }

    void addSurface(double offset, double slopeX, double slopeY, Shape shape, double centerX, double centerY,
                    double radiusX, double radiusY, int contrast)
    {
        Surface s = {
            offset, slopeX, slopeY, shape, centerX, centerY, radiusX, radiusY, contrast, Vec3i(), Mat(), Mat()
        };
        if (shape != WHOLE) // slopes turn about the centre
            s.offset -= slopeX * centerX + slopeY * centerY;
        for (int c = 0; c < 3; ++c)
            s.base[c] = rng_.uniform(70, 180);
        const Size area(2 * size_.width + 2, size_.height + 2); // also what only the right image sees
        s.fine.create(area, CV_8UC3);
        rng_.fill(s.fine, RNG::UNIFORM, 0, 256);
        s.coarse.create(Size(area.width / 8 + 2, area.height / 8 + 2), CV_8UC3);
        rng_.fill(s.coarse, RNG::UNIFORM, 0, 256);
        surfaces_.push_back(s);
    }

    //! The front surface at a column of the left or right image.
    Hit look(double column, double y, bool fromRight) const
    {
        Hit front = { -1, 0, -1 };
        for (size_t i = 0; i < surfaces_.size(); ++i)
        {
            const Surface& s = surfaces_[i];
            const double x = fromRight ? (column + s.offset + s.slopeY * y) / (1 - s.slopeX) : column;
            const double disparity = s.offset + s.slopeX * x + s.slopeY * y;
            if (s.covers(x, y) && disparity > front.disparity)
            {
                const Hit hit = { (int)i, x, disparity };
                front = hit;
            }
        }
        return front;
    }

    //! Bilinear, of channel c
    static double interpolate(const Mat& noise, double x, double y, int c)
    {
        const int x0 = std::min(std::max((int)x, 0), noise.cols - 2),
                  y0 = std::min(std::max((int)y, 0), noise.rows - 2);
        const double fx = x - x0, fy = y - y0;
        return (1 - fy) * ((1 - fx) * noise.at<Vec3b>(y0, x0)[c] + fx * noise.at<Vec3b>(y0, x0 + 1)[c]) +
               fy * ((1 - fx) * noise.at<Vec3b>(y0 + 1, x0)[c] + fx * noise.at<Vec3b>(y0 + 1, x0 + 1)[c]);
    }

    Vec3b color(const Hit& hit, int y)
    {
        const Surface& s = surfaces_[hit.surface];
        const bool textured = s.isTextured(hit.x, y, size_);
        Vec3b result;
        for (int c = 0; c < 3; ++c)
        {
            double value = s.base[c];
            if (textured)
                value += s.contrast *
                         (0.4 * (interpolate(s.fine, hit.x, y, c) - 127.5) +
                          1.2 * (interpolate(s.coarse, hit.x / 8, y / 8., c) - 127.5)) /
                         255;
            result[c] = saturate_cast<uchar>((int)value + rng_.uniform(-2, 3));
        }
        return result;
    }

    Size size_;
    RNG rng_;
    std::vector<Surface> surfaces_;
};

inline SyntheticPair makeSyntheticPair(Size size, int numDisparities, int seed)
{
    return SyntheticScene(size, numDisparities, seed, false).render();
}

//! Only the slanted plane at the back
inline SyntheticPair makeSlantedPlane(Size size, int numDisparities, int seed)
{
    return SyntheticScene(size, numDisparities, seed, true).render();
}

//! Mean distance to the truth, in pixels, of the disparities in the mask. Types as in badPixels().
inline double meanError(const Mat& disparity, const Mat& truth, const Mat& mask)
{
    double sum = 0;
    for (int y = 0; y < truth.rows; ++y)
        for (int x = 0; x < truth.cols; ++x)
            if (mask.at<uchar>(y, x))
                sum += std::abs(disparity.at<short>(y, x) / 16. - truth.at<float>(y, x));
    return sum / cv::countNonZero(mask);
}

//! Percentage of the pixels in the mask whose disparity is wrong by at least a limit. disparity: CV_16SC1, times
//! 16; truth: CV_32FC1.
inline double badPixels(const Mat& disparity, const Mat& truth, const Mat& mask, double limit)
{
    int bad = 0;
    for (int y = 0; y < truth.rows; ++y)
        for (int x = 0; x < truth.cols; ++x)
            if (mask.at<uchar>(y, x) && std::abs(disparity.at<short>(y, x) / 16. - truth.at<float>(y, x)) >= limit)
                ++bad;
    return 100. * bad / cv::countNonZero(mask);
}

//! A BGR image as one of another type: grey, with four times the levels in CV_16UC1, or with alpha
inline Mat ofType(const Mat& bgr, int type)
{
    Mat grey, image;
    cv::cvtColor(bgr, grey, COLOR_BGR2GRAY);
    if (type == CV_8UC4)
        cv::cvtColor(bgr, image, COLOR_BGR2BGRA);
    else if (CV_MAT_CN(type) == 3)
        image = bgr.clone();
    else
        grey.convertTo(image, type, type == CV_16UC1 ? 4 : 1);
    return image;
}

} // namespace opencv_test

#endif
