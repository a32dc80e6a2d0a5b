// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TEST_REPETITIVE_PAIR_HPP
#define OPENCV_HDPSTEREO_TEST_REPETITIVE_PAIR_HPP

#include "test_precomp.hpp"

namespace opencv_test {

enum RepetitivePattern
{
    STRIPES, //!< vertical, as a fence
    RAILS,   //!< horizontal
    GRID,
    BRICKS
};

/** A panel with a regular pattern before a textured background, with independent noise in both images. Inside, the
disparity is that of the panel or some periods off: where it ends, only one of them fits. */
struct RepetitivePair
{
    enum
    {
        numDisparities = 64,
        panelDisparity = 40,
        backgroundDisparity = 10
    };
    Mat left, right; // CV_8UC1
    Rect inside;     // of the panel in the left image, but for its border

    //! noise: standard deviation; the seed also decides where the panel is
    RepetitivePair(RepetitivePattern pattern, int period, double noise, int seed)
    {
        RNG rng((uint64)(seed + 1));
        const Size size(560, 320);
        const Mat background = texture(Size(size.width + backgroundDisparity, size.height), rng);
        const int x = rng.uniform(170, 190), y = rng.uniform(50, 70);
        const Rect panel(x, y, 300, 200);
        const int border = 6;
        inside = Rect(x + border, y + border, panel.width - 2 * border, panel.height - 2 * border);
        const Mat wall = render(pattern, period, panel.size());
        left = background.colRange(0, size.width).clone();
        right = background.colRange(backgroundDisparity, backgroundDisparity + size.width).clone();
        wall.copyTo(left(panel));
        wall.copyTo(right(panel - Point(panelDisparity, 0)));
        for (Mat* image : { &left, &right })
        {
            Mat added(image->size(), CV_16S);
            rng.fill(added, RNG::NORMAL, 0, noise);
            cv::add(*image, added, *image, cv::noArray(), CV_8U);
        }
    }

    //! Percentage of the inside that is off by more than a pixel. disparity: CV_16SC1, times 16
    double percentWrong(const Mat& disparity) const
    {
        int wrong = 0;
        for (const short d : Mat_<short>(disparity(inside)))
            wrong += std::abs(d - 16 * panelDisparity) > 16;
        return 100. * wrong / inside.area();
    }

private:
    //! What all layers see: noise of one pixel and of eight
    static Mat texture(Size size, RNG& rng)
    {
        Mat fine(size, CV_8U), coarse(size.height / 8 + 1, size.width / 8 + 1, CV_8U);
        rng.fill(fine, RNG::UNIFORM, 0, 128);
        rng.fill(coarse, RNG::UNIFORM, 0, 128);
        cv::resize(coarse, coarse, size, 0, 0, INTER_NEAREST);
        return fine / 4 + coarse / 2 + 60;
    }

    static Mat render(RepetitivePattern pattern, int period, Size size)
    {
        const int joint = 2; // pixels between bricks, and of the bars of a grid
        Mat wall(size, CV_8U);
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
            {
                const int row = 2 * y / period, shift = row % 2 * period / 2; // of bricks
                const bool isLight = pattern == STRIPES ? x % period < period / 2
                                     : pattern == RAILS ? y % period < period / 2
                                     : pattern == GRID  ? x % period < joint || y % period < joint
                                                        : y % (period / 2) < joint || (x + shift) % period < joint;
                wall.at<uchar>(y, x) = isLight ? 188 : 68;
            }
        return wall;
    }
};

} // namespace opencv_test

#endif
