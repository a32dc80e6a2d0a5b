// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "../src/forest/tree_planes.hpp"
#include "../src/forest/tree_walk.hpp"

namespace opencv_test { namespace {

const int candidates = 48;
const int flatCost = 60, winnerCost = 40; // in units of the volume

//! A layer whose trees are the surfaces of a colour, with costs that are the same for all candidates, and winners 0
struct Layer
{
    hdp::DisparityForest forest;
    hdp::CostVolume volume;
    Mat disparity;

    explicit Layer(const Mat& colors, int steps = 1) : disparity(colors.size(), CV_16U, Scalar(0))
    {
        hdp::ForestBuffers buffers;
        hdp::buildForest(colors, Mat(colors.size(), CV_16UC2, Scalar(0, candidates - 1)), *createSegmentTree(),
                         { 0.6, false }, buffers, forest);
        volume.create(forest);
        volume.steps = steps;
        hdp::TreeWalk walk;
        for (size_t t = 0; t < forest.trees.size(); ++t)
        {
            hdp::walkTree(forest, forest.trees[t], walk);
            volume.place(forest, t, walk.pixels.data());
        }
        std::fill(volume.costs.begin(), volume.costs.end(), (uchar)flatCost);
    }

    uchar* costs(int x, int y) { return &volume.costs[volume.of(y * disparity.cols + x).start()]; }

    //! The disparity of a pixel with so low a cost
    void win(int x, int y, double value, int cost = winnerCost)
    {
        disparity.at<ushort>(y, x) = (ushort)cvRound(value * hdp::subpixelScale);
        costs(x, y)[cvRound(volume.steps * value)] = (uchar)cost;
    }

    int preferPlanes() { return hdp::preferTreePlanes(forest, disparity, volume); }
};

Mat twoSurfaces(Size size, int left)
{
    Mat colors(size, CV_8U, Scalar(40));
    colors.colRange(left, size.width).setTo(200);
    return colors;
}

double slanted(int x, int y) { return 4 + 0.09 * x + 0.05 * y; }

//! What a plane adds to the cost of a candidate
int penalty(double plane, int candidate)
{
    return std::min(cvRound(hdp::CostVolume::scale * std::abs(candidate - plane)), 10);
}

//! Half of a surface is bare, and has disparities of its neighbour.
//! steps: candidates per pixel of disparity
void preferPlanesOfBareHalf(int steps)
{
    const Size size(80, 60);
    const int left = 30;
    Layer layer(twoSurfaces(size, left), steps);
    ASSERT_EQ(2u, layer.forest.trees.size());
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
        {
            if (x < left)
                layer.win(x, y, 20);
            else if (y < size.height / 2)
                layer.win(x, y, slanted(x, y));
            else
                layer.disparity.at<ushort>(y, x) = (ushort)(20 * hdp::subpixelScale);
        }
    EXPECT_EQ(2, layer.preferPlanes());
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
        {
            const double plane = steps * (x < left ? 20 : slanted(x, y));
            const bool isBare = x >= left && y >= size.height / 2;
            for (int k = 0; k < candidates; ++k)
                ASSERT_NEAR((!isBare && k == cvRound(plane) ? winnerCost : flatCost) + penalty(plane, k),
                            layer.costs(x, y)[k], 1)
                    << k << " at " << x << ", " << y;
        }
}

TEST(HDPStereo_TreePlanes, bare_half) { preferPlanesOfBareHalf(1); }

TEST(HDPStereo_TreePlanes, candidates_of_half_a_pixel) { preferPlanesOfBareHalf(2); }

//! Pixels whose costs are 3 bits lower elsewhere are those of another surface.
TEST(HDPStereo_TreePlanes, other_surface_in_front)
{
    const Size size(60, 50);
    const Rect front(20, 15, 3, 30);
    for (int cost : { flatCost - 23, flatCost - 25 })
    {
        Layer layer(Mat(size, CV_8U, Scalar(90)));
        ASSERT_EQ(1u, layer.forest.trees.size());
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                if (front.contains(Point(x, y)))
                    layer.win(x, y, 18, cost);
                else
                    layer.win(x, y, 6);
        const std::vector<uchar> before = layer.volume.costs;
        EXPECT_EQ(1, layer.preferPlanes());
        const size_t pixel = layer.costs(front.x, front.y) - layer.volume.costs.data();
        const bool isKept = std::equal(&before[pixel], &before[pixel] + candidates, layer.costs(front.x, front.y));
        EXPECT_EQ(cost == flatCost - 25, isKept) << cost;
    }
}

void expectNoPlane(Layer& layer)
{
    const std::vector<uchar> before = layer.volume.costs;
    EXPECT_EQ(0, layer.preferPlanes());
    EXPECT_TRUE(before == layer.volume.costs);
}

TEST(HDPStereo_TreePlanes, no_plane)
{
    const Mat oneColor(Size(60, 50), CV_8U, Scalar(90));
    {
        SCOPED_TRACE("costs that tell nothing");
        Layer layer(oneColor);
        expectNoPlane(layer);
    }
    {
        SCOPED_TRACE("a surface that is bent");
        Layer layer(oneColor);
        for (int y = 0; y < oneColor.rows; ++y)
            for (int x = 0; x < oneColor.cols; ++x)
                layer.win(x, y, 11 + 9 * std::sin(0.2 * x) * std::cos(0.2 * y));
        expectNoPlane(layer);
    }
    {
        SCOPED_TRACE("disparities by chance");
        Layer layer(oneColor);
        RNG rng(5);
        for (int y = 0; y < oneColor.rows; ++y)
            for (int x = 0; x < oneColor.cols; ++x)
                layer.win(x, y, rng.uniform(0, candidates));
        expectNoPlane(layer);
    }
    {
        SCOPED_TRACE("a small tree");
        Layer layer(Mat(Size(23, 13), CV_8U, Scalar(90))); // 299 pixels
        for (int y = 0; y < 13; ++y)
            for (int x = 0; x < 23; ++x)
                layer.win(x, y, 7);
        expectNoPlane(layer);
    }
}

TEST(HDPStereo_TreePlanes, pixels_of_one_row)
{
    Layer layer(Mat(Size(500, 1), CV_8U, Scalar(90)));
    for (int x = 0; x < 500; ++x)
        layer.win(x, 0, 3 + 0.03 * x);
    EXPECT_EQ(1, layer.preferPlanes());
    for (int x = 0; x < 500; x += 25)
        EXPECT_NEAR(flatCost + 10, layer.costs(x, 0)[cvRound(3 + 0.03 * x) + 3], 1) << x;
}

}} // namespace opencv_test
