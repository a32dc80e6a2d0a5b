// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "pair_pyramids.hpp"

#include "../base/vectorized.hpp"
#include "image_levels.hpp"
#include "image_pyramid.hpp"

namespace cv { namespace stereo { namespace hdp {

void checkPair(const Mat& left, const Mat& right)
{
    if (left.empty())
        CV_Error(Error::StsBadArg, "left must not be empty");
    const int type = left.type();
    if (left.dims != 2 ||
        (type != CV_8UC1 && type != CV_8UC3 && type != CV_8UC4 && type != CV_16UC1 && type != CV_32FC1))
        CV_Error(Error::StsUnsupportedFormat, "left must be CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1 or CV_32FC1");
    if (right.dims != 2 || right.size() != left.size())
        CV_Error(Error::StsUnmatchedSizes, "right must have the size of left");
    if (right.type() != left.type())
        CV_Error(Error::StsUnmatchedFormats, "right must have the type of left");
    if (std::max(left.cols, left.rows) > maxSide)
        CV_Error(Error::StsOutOfRange,
                 format("left must be at most %d pixels wide and high, not %d x %d", maxSide, left.cols, left.rows));
    if (left.total() * left.elemSize() > (size_t)INT_MAX)
        CV_Error(Error::StsOutOfRange, "left must have less than 2^31 bytes");
}

namespace {

//! Without the levels of what has no data
Mat blackened(const Mat& image, const Mat& mask)
{
    if (mask.empty())
        return image;
    Mat blackened(image.size(), image.type(), Scalar::all(0));
    image.copyTo(blackened, mask);
    return blackened;
}

double shareWithData(const PairMasks& masks)
{
    return masks.isEmpty() ? 1
                           : (countNonZero(masks.left) + (double)countNonZero(masks.right)) / (2. * masks.left.total());
}

//! Those of images that are extended and moved as the plan says
void buildMasks(const PairMasks& masks, const PyramidPlan& plan, PairPyramids& pyramids)
{
    Mat extended, shifted;
    shiftColumns(masks.right, plan.minDisparity, plan.extension, shifted);
    shiftColumns(masks.left, 0, plan.extension, extended);
    buildPyramid({ extended }, plan.layers, pyramids.leftMask);
    buildPyramid({ shifted }, plan.layers, pyramids.rightMask);
}

//! Grey levels of an extended pair with its masks, brightened if it is dark, and without the blocks of compression.
//! share: with data
void makeLevels(const Mat& left, const Mat& right, const PairMasks& masks, double share, const PyramidPlan& plan,
                bool isKnown, PairPyramids& pyramids)
{
    LevelFindings& found = pyramids.levels;
    Mat &leftLevels = pyramids.leftLevels, &rightLevels = pyramids.rightLevels;
    const auto convert = [&] {
        greyLevels(left, found.bits, leftLevels, found.brightness);
        greyLevels(right, found.bits, rightLevels, found.brightness);
    };
    convert();
    if (!isKnown)
    {
        found.brightness =
            findBrightness(blackened(leftLevels, masks.left), blackened(rightLevels, masks.right), share);
        if (found.brightness > 1)
            convert();
    }
    if (!plan.smoothsBlocks)
        return;
    if (!isKnown)
    {
        found.leftBlocks = findBlocks(leftLevels);
        found.rightBlocks = findBlocks(rightLevels);
    }
    smoothBlocks(leftLevels, rightLevels, found.leftBlocks, found.rightBlocks);
}

} // namespace

void buildPairPyramids(const Mat& left, const Mat& right, const PairMasks& masks, const PyramidPlan& plan,
                       PairPyramids& pyramids, std::vector<LayerImages>& images, const LevelFindings* given)
{
    const int minDisparity = plan.minDisparity, extension = plan.extension, layers = plan.layers;
    Mat extended = left, shifted = right;
    if (minDisparity != 0)
    {
        shiftColumns(right, minDisparity, extension, pyramids.shiftedRight);
        shifted = pyramids.shiftedRight;
    }
    if (extension > 0)
    {
        shiftColumns(left, 0, extension, pyramids.extendedLeft);
        extended = pyramids.extendedLeft;
    }
    if (!masks.isEmpty())
        buildMasks(masks, plan, pyramids);
    const double share = shareWithData(masks);
    LevelFindings& levels = pyramids.levels;
    levels = given ? *given : LevelFindings();
    if (!given)
        levels.bits = bitsInUse(blackened(left, masks.left), blackened(right, masks.right), share);
    if (plan.isCensus)
    {
        const PairMasks moved = masks.isEmpty() ? masks : PairMasks({ pyramids.leftMask[0], pyramids.rightMask[0] });
        makeLevels(extended, shifted, moved, share, plan, given != nullptr, pyramids);
        buildPyramid({ pyramids.leftLevels }, layers, pyramids.leftGrey);
        buildPyramid({ pyramids.rightLevels }, layers, pyramids.right);
    }
    else
        buildPyramid({ byteLevels(shifted, levels.bits, pyramids.rightBytes) }, layers, pyramids.right);
    buildPyramid({ byteLevels(extended, levels.bits, pyramids.leftBytes, levels.brightness) }, layers, pyramids.left);
    images.resize(layers);
    for (int layer = 0; layer < layers; ++layer)
    {
        images[layer].guide = pyramids.left[layer];
        images[layer].left = plan.isCensus ? pyramids.leftGrey[layer] : pyramids.left[layer];
        images[layer].right = pyramids.right[layer];
        images[layer].masks =
            masks.isEmpty() ? masks : PairMasks({ pyramids.leftMask[layer], pyramids.rightMask[layer] });
    }
    pyramids.left[0].release(); // may be the caller's
    pyramids.right[0].release();
}

void shiftColumns(const Mat& image, int minDisparity, int extension, Mat& shifted)
{
    const int width = image.cols + extension;
    const int64 shift = (int64)minDisparity + extension; // minDisparity is any int
    const auto columnAt = [&](int x) { return (int)clamped<int64>(x - shift, 0, image.cols - 1); };
    const Mat inside = image.colRange(columnAt(0), columnAt(width - 1) + 1);
    const int rest = width - inside.cols, before = (int)clamped<int64>(shift, 0, rest);
    // Isolated: around a region of a larger image, that is not looked at.
    copyMakeBorder(inside, shifted, 0, 0, before, rest - before, BORDER_REPLICATE | BORDER_ISOLATED);
}

}}} // namespace cv::stereo::hdp
