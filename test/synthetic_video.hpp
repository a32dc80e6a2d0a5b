// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEST_SYNTHETIC_VIDEO_HPP
#define OPENCV_HDPSTEREO_TEST_SYNTHETIC_VIDEO_HPP

#include "test_precomp.hpp"

namespace opencv_test {

//! A frame with exact truth
struct SyntheticFrame
{
    Mat left, right; // CV_8UC1
    Mat truth;       // CV_32FC1
    Mat visible;     // CV_8UC1: 255 where the right image shows the same point
};

//! A textured rectangle parallel to the images, in a frame in which the cameras are at rest at the origin
struct Board
{
    Rect2d area;      // in pixels of the left image
    double disparity; // there
    int seed;         // of the texture
};

/** Frames of boards in front of one that fills the image. A camera that moves by (x, y, z) sees the point (u, v), from
the centre of the image, with disparity d at s (u - x d, v - y d) with disparity s d, where s = 1 / (1 - z d). Only + - *
/ and integer random numbers go into it. */
class SyntheticVideo
{
public:
    //! boardContrast: of the boards, in times that of what is behind them
    SyntheticVideo(Size size, double backDisparity, double noise, double boardContrast = 1)
        : size_(size), backDisparity_(backDisparity), noise_(noise), boardContrast_(boardContrast)
    {
    }

    //! index: seed of the noise
    SyntheticFrame render(int index, const std::vector<Board>& boards = std::vector<Board>(),
                          Point3d camera = Point3d())
    {
        std::vector<Board> all(1);
        all[0].area = Rect2d(-10. * size_.width, -10. * size_.height, 20. * size_.width, 20. * size_.height);
        all[0].disparity = backDisparity_;
        all[0].seed = 1;
        all.insert(all.end(), boards.begin(), boards.end());
        SyntheticFrame frame;
        frame.left.create(size_, CV_8U);
        frame.right.create(size_, CV_8U);
        frame.truth.create(size_, CV_32F);
        frame.visible.create(size_, CV_8U);
        RNG rng((uint64)index + 77);
        for (int y = 0; y < size_.height; ++y)
            for (int x = 0; x < size_.width; ++x)
            {
                const Hit left = look(all, camera, x, y, false), right = look(all, camera, x, y, true);
                frame.left.at<uchar>(y, x) = level(left, rng);
                frame.right.at<uchar>(y, x) = level(right, rng);
                frame.truth.at<float>(y, x) = (float)left.disparity;
                const double there = x - left.disparity;
                frame.visible.at<uchar>(y, x) =
                    there >= 0 && look(all, camera, there, y, true).board == left.board ? 255 : 0;
            }
        return frame;
    }

private:
    struct Hit
    {
        const Board* board;
        double u, v, disparity;
    };

    Hit look(const std::vector<Board>& boards, const Point3d& camera, double x, double y, bool fromRight) const
    {
        Hit front = { nullptr, 0, 0, -1 };
        const Point2d centre(size_.width / 2, size_.height / 2);
        for (const Board& board : boards)
        {
            const double s = 1 / (1 - camera.z * board.disparity), disparity = s * board.disparity;
            const double u = (x + (fromRight ? disparity : 0) - centre.x) / s + camera.x * board.disparity + centre.x;
            const double v = (y - centre.y) / s + camera.y * board.disparity + centre.y;
            const Rect2d& a = board.area;
            const bool covers = u >= a.x && v >= a.y && u < a.x + a.width && v < a.y + a.height;
            if (covers && disparity > front.disparity)
            {
                const Hit hit = { &board, u - (board.seed == 1 ? 0 : a.x), v - (board.seed == 1 ? 0 : a.y), disparity };
                front = hit;
            }
        }
        return front;
    }

    //! A random level of each point of a grid
    static double grid(int seed, int x, int y)
    {
        uint64 h = (uint64)seed * 0x9E3779B97F4A7C15ULL + (uint64)(x + 65536) * 0xC2B2AE3D27D4EB4FULL +
                   (uint64)(y + 65536) * 0x165667B19E3779F9ULL;
        h ^= h >> 29;
        h *= 0xBF58476D1CE4E5B9ULL;
        h ^= h >> 32;
        return (double)(h & 255);
    }

    static double texture(int seed, double u, double v)
    {
        const double x = u + 32768, y = v + 32768;
        const int x0 = (int)x - 32768, y0 = (int)y - 32768;
        const double fx = u - x0, fy = v - y0;
        return (1 - fy) * ((1 - fx) * grid(seed, x0, y0) + fx * grid(seed, x0 + 1, y0)) +
               fy * ((1 - fx) * grid(seed, x0, y0 + 1) + fx * grid(seed, x0 + 1, y0 + 1));
    }

    uchar level(const Hit& hit, RNG& rng) const
    {
        const int seed = hit.board->seed;
        const double base = 90 + 60 * (seed % 2);
        const double contrast = seed == 1 ? 1 : boardContrast_;
        const double value = base + contrast * (0.25 * (texture(2 * seed, hit.u / 2, hit.v / 2) - 127.5) +
                                                0.4 * (texture(2 * seed + 1, hit.u / 12, hit.v / 12) - 127.5));
        double sum = 0; // of uniform numbers, about normal
        for (int i = 0; noise_ > 0 && i < 12; ++i)
            sum += rng.uniform(-1000, 1001) / 2000.;
        return saturate_cast<uchar>((int)(value + noise_ * sum + 0.5));
    }

    Size size_;
    double backDisparity_, noise_, boardContrast_;
};

} // namespace opencv_test

#endif
