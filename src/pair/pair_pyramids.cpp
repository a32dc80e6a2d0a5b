// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "pair_pyramids.hpp"

#include "../base/vectorized.hpp"
#include "image_pyramid.hpp"

namespace cv { namespace stereo { namespace hdp {

void checkPair(const Mat& left, const Mat& right)
{
    if (left.empty())
        CV_Error(Error::StsBadArg, "left must not be empty");
    const int type = left.type();
    for (const Mat* image : { &left, &right })
        if (image->dims > 2)
            CV_Error(Error::StsUnsupportedFormat, format("%s must be an image, not an array of %d dimensions",
                                                         image == &left ? "left" : "right", image->dims));
    if (type != CV_8UC1 && type != CV_8UC3 && type != CV_8UC4 && type != CV_16UC1 && type != CV_32FC1)
        CV_Error(Error::StsUnsupportedFormat,
                 "left must be CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1 or CV_32FC1, not " + typeToString(type));
    if (right.size() != left.size())
        CV_Error(Error::StsUnmatchedSizes, format("right must have the size of left, %d x %d, not %d x %d", left.cols,
                                                  left.rows, right.cols, right.rows));
    if (right.type() != left.type())
        CV_Error(Error::StsUnmatchedFormats,
                 "right must have the type of left, " + typeToString(type) + ", not " + typeToString(right.type()));
    if (std::max(left.cols, left.rows) > maxSide)
        CV_Error(Error::StsOutOfRange,
                 format("left must be at most %d pixels wide and high, not %d x %d", maxSide, left.cols, left.rows));
    if (left.total() * left.elemSize() > (size_t)INT_MAX)
        CV_Error(Error::StsOutOfRange, "left must have less than 2^31 bytes");
}

namespace {

//! The image with black pixels where there is no data; itself without a mask
Mat blackened(const Mat& image, const Mat& mask)
{
    if (mask.empty())
        return image;
    Mat blackened(image.size(), image.type(), Scalar::all(0));
    image.copyTo(blackened, mask);
    return blackened;
}

//! Makes the grey levels of a pair that is moved, as are its masks: brightened if it is dark, without the blocks of
//! compression. share: of the pixels, with data; isKnown: whether pyramids.levels were given
void makeLevels(const Mat& left, const Mat& right, const PairMasks& masks, double share, bool isKnown,
                bool smoothsBlocks, PairPyramids& pyramids)
{
    LevelFindings& found = pyramids.levels;
    Mat &leftLevels = pyramids.left.levels, &rightLevels = pyramids.right.levels;
    const auto convert = [&] {
        greyLevels(left, found.scale, leftLevels);
        greyLevels(right, found.scale, rightLevels);
    };
    convert();
    if (!isKnown)
    {
        found.scale.brightness =
            findBrightness(blackened(leftLevels, masks.left), blackened(rightLevels, masks.right), share);
        if (found.scale.brightness > 1)
            convert();
    }
    if (!smoothsBlocks)
        return;
    if (!isKnown)
    {
        parallelFor(2, [&](int i) {
            (i == 0 ? found.leftBlocks : found.rightBlocks) =
                findBlocks(i == 0 ? leftLevels : rightLevels, found.scale.gain());
        });
    }
    smoothBlocks(leftLevels, rightLevels, found.leftBlocks, found.rightBlocks);
}

//! The masks of a layer, with the columns in which its images begin behind added and moved ones
PairMasks layerMasks(const Mat& left, const Mat& right, const PyramidPlan& plan, int layer)
{
    PairMasks masks(left, right);
    masks.leftBegin = plan.extension >> layer;
    masks.rightBegin = (int)clamped<int64>((int64)plan.extension + plan.minDisparity, 0, INT_MAX) >> layer;
    masks.wholeWidth = plan.wholeWidth >> layer;
    return masks;
}

} // namespace

void buildPairPyramids(const Mat& left, const Mat& right, const PairMasks& masks, const PyramidPlan& plan,
                       PairPyramids& pyramids, std::vector<LayerImages>& images, const LevelFindings* given)
{
    const int minDisparity = plan.minDisparity, extension = plan.extension, layers = plan.layers;
    ImagePyramids &l = pyramids.left, &r = pyramids.right;
    const Mat movedLeft = shiftColumns(left, 0, extension, l.moved),
              movedRight = shiftColumns(right, minDisparity, extension, r.moved);
    Mat leftMask, rightMask;
    const PairMasks movedMasks = { shiftColumns(masks.left, 0, extension, leftMask),
                                   shiftColumns(masks.right, minDisparity, extension, rightMask) };
    const double all = 2. * left.total(); // pixels
    const double share = masks.isEmpty() ? 1 : ((double)countNonZero(masks.left) + countNonZero(masks.right)) / all;
    LevelFindings& levels = pyramids.levels;
    levels = given ? *given : LevelFindings();
    if (!given)
    {
        levels.scale.bits = bitsInUse(blackened(left, masks.left), blackened(right, masks.right), share);
        if (plan.findsEnds)
            findEnds(left, right, masks, levels.scale);
        levels.isGrey = hasNoColours(left);
    }
    if (plan.isCensus)
        makeLevels(movedLeft, movedRight, movedMasks, share, given != nullptr, plan.smoothsBlocks, pyramids);
    const Mat leftBytes = byteLevels(movedLeft, levels.scale, l.bytes);
    buildPyramid({ leftBytes }, layers, l.colours);
    if (plan.isCensus)
        buildPyramid({ l.levels }, layers, l.matched);
    else
        l.matched = l.colours;
    buildPyramid({ plan.isCensus ? r.levels : byteLevels(movedRight, levels.scale, r.bytes) }, layers, r.matched);
    buildPyramid({ movedMasks.left }, layers, l.mask);
    buildPyramid({ movedMasks.right }, layers, r.mask);
    images.resize(layers);
    const bool seesLevels = plan.isCensus && levels.isGrey;
    for (int layer = 0; layer < layers; ++layer)
        images[layer] = { l.colours[layer], seesLevels ? l.matched[layer] : l.colours[layer], l.matched[layer],
                          r.matched[layer], layerMasks(l.mask[layer], r.mask[layer], plan, layer) };
    for (std::vector<Mat>* pyramid : { &l.colours, &l.matched, &r.matched, &l.mask, &r.mask })
        pyramid->front().release(); // it may be the caller's image, of which nothing is kept after this pair
}

Mat shiftColumns(const Mat& image, int minDisparity, int extension, Mat& memory)
{
    if (image.empty() || (minDisparity == 0 && extension == 0))
        return image;
    const int width = image.cols + extension;
    const int64 shift = (int64)minDisparity + extension; // minDisparity is any int
    const auto columnAt = [&](int x) { return (int)clamped<int64>(x - shift, 0, image.cols - 1); };
    const Mat inside = image.colRange(columnAt(0), columnAt(width - 1) + 1);
    const int rest = width - inside.cols, before = (int)clamped<int64>(shift, 0, rest);
    // Isolated: if the image is a region of a larger one, pixels around it are not read.
    copyMakeBorder(inside, memory, 0, 0, before, rest - before, BORDER_REPLICATE | BORDER_ISOLATED);
    return memory;
}

}}} // namespace cv::stereo::hdp
