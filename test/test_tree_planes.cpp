// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "../src/forest/tree_planes.hpp"

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
        hdp::buildForest(colors, Mat(colors.size(), CV_16UC2, Scalar(0, candidates - 1)), *createSegmentTree(), 0.6,
                         false, buffers, forest);
        volume.create(colors.size(), candidates, steps);
        hdp::TreeWalk walk;
        for (const hdp::DisparityTree& tree : forest.trees)
        {
            hdp::walkTree(forest, tree, walk);
            volume.treeStarts.push_back((int)volume.treePixels.size());
            volume.treePixels.insert(volume.treePixels.end(), walk.pixels.begin(), walk.pixels.begin() + tree.size);
        }
        std::fill(volume.costs.begin(), volume.costs.end(), (uchar)flatCost);
    }

    uchar* costs(int x, int y) { return &volume.costs[volume.start(y * disparity.cols + x)]; }

    //! The disparity of a pixel with so low a cost
    void win(int x, int y, double value, int cost = winnerCost)
    {
        disparity.at<ushort>(y, x) = (ushort)cvRound(value * hdp::subpixelScale);
        costs(x, y)[cvRound(volume.steps * value)] = (uchar)cost;
    }

    int takePlanes() { return hdp::takeTreePlanes(forest, volume, disparity); }
};

Mat twoSurfaces(Size size, int left)
{
    Mat colors(size, CV_8U, Scalar(40));
    colors.colRange(left, size.width).setTo(200);
    return colors;
}

double slanted(int x, int y) { return 4 + 0.09 * x + 0.05 * y; }

void expectDisparity(double expected, const Layer& layer, int x, int y)
{
    ASSERT_NEAR(hdp::subpixelScale * expected, layer.disparity.at<ushort>(y, x), 1) << x << ", " << y;
}

//! Half of a surface is bare, and has disparities of its neighbour.
//! steps: candidates per pixel of disparity
void takePlanesOfBareHalf(int steps)
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
    EXPECT_EQ(2, layer.takePlanes());
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
            expectDisparity(x < left ? 20 : slanted(x, y), layer, x, y);
}

TEST(HDPStereo_TreePlanes, bare_half) { takePlanesOfBareHalf(1); }

TEST(HDPStereo_TreePlanes, candidates_of_half_a_pixel) { takePlanesOfBareHalf(2); }

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
        EXPECT_EQ(1, layer.takePlanes());
        expectDisparity(cost == flatCost - 25 ? 18 : 6, layer, front.x, front.y);
        expectDisparity(6, layer, 0, 0);
    }
}

void expectNoPlane(Layer& layer)
{
    const Mat before = layer.disparity.clone();
    EXPECT_EQ(0, layer.takePlanes());
    expectIdentical(before, layer.disparity);
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

//! What each pixel prefers is noise, of so many units, but some disparities cost 3 units less than others in all pixels.
//! Expects the whole tree to take the first of these, or none.
void expectOfNoise(int noise, const std::vector<int>& better, bool isTaken)
{
    SCOPED_TRACE(cv::format("noise %d, from disparity %d on", noise, better[0]));
    const Size size(60, 50);
    Layer layer(Mat(size, CV_8U, Scalar(90)));
    RNG rng(7);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
        {
            for (int disparity : better)
                layer.costs(x, y)[disparity] = flatCost - 3;
            layer.win(x, y, rng.uniform(0, candidates), flatCost - noise);
        }
    if (!isTaken)
        return expectNoPlane(layer);
    EXPECT_EQ(1, layer.takePlanes());
    EXPECT_EQ(size.area(), countNonZero(layer.disparity == better[0] * hdp::subpixelScale));
}

TEST(HDPStereo_TreePlanes, noise_stronger_than_texture)
{
    expectOfNoise(7, { 12 }, true);
    expectOfNoise(7, { 12, 30 }, false); // one is as good as the other
    expectOfNoise(7, { 2 }, false);      // what is beyond the range may be better
    expectOfNoise(7, { candidates - 3 }, false);
    expectOfNoise(3 + hdp::CostVolume::scale + 1, { 12 }, false); // the costs are against it
}

TEST(HDPStereo_TreePlanes, pixels_of_one_row)
{
    Layer layer(Mat(Size(500, 1), CV_8U, Scalar(90)));
    for (int x = 0; x < 500; ++x)
        layer.win(x, 0, 3 + 0.03 * x);
    for (int x = 3; x < 500; x += 5)
        layer.disparity.at<ushort>(0, x) = 0;
    EXPECT_EQ(1, layer.takePlanes());
    for (int x = 0; x < 500; ++x)
        expectDisparity(3 + 0.03 * x, layer, x, 0);
}

//! Planes go on beyond the last candidate, disparities do not.
TEST(HDPStereo_TreePlanes, end_with_the_range)
{
    Layer layer(Mat(Size(80, 60), CV_8U, Scalar(90)));
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 80; ++x)
            layer.win(x, y, std::min(0.8 * x, candidates - 1.));
    EXPECT_EQ(1, layer.takePlanes());
    expectDisparity(0.8 * 50, layer, 50, 30);
    expectDisparity(candidates - 1, layer, 79, 30);
}

}} // namespace opencv_test
