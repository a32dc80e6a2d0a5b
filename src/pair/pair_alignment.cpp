// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "pair_alignment.hpp"

#include "image_levels.hpp"
#include "image_pyramid.hpp"

#include "opencv2/imgproc.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

//! Both images by a small Gaussian
void smooth(LayerImages& images, LayerImages& smoothed)
{
    const double deviation = 0.5; // in pixels
    GaussianBlur(images.left, smoothed.left, Size(3, 3), deviation, deviation, BORDER_REPLICATE);
    GaussianBlur(images.right, smoothed.right, Size(3, 3), deviation, deviation, BORDER_REPLICATE);
    images.left = smoothed.left;
    images.right = smoothed.right;
}

} // namespace

void alignPair(const AlignmentSearch& search, AlignmentBuffers& buffers, std::vector<LayerImages>& images,
               PairAlignment& alignment)
{
    alignment = PairAlignment();
    const bool isGrey = images[0].right.depth() == CV_16U; // see greyLevels()
    std::vector<Mat> left, right;
    if (isGrey)
        for (const LayerImages& layer : images)
        {
            left.push_back(layer.left);
            right.push_back(layer.right);
        }
    else
    {
        greyLevels(images[0].left, 8, buffers.leftLevels);
        greyLevels(images[0].right, 8, buffers.rightLevels);
        left.push_back(buffers.leftLevels);
        right.push_back(buffers.rightLevels);
    }
    matchCoarsely(left, right, search.numDisparities, buffers.coarse);
    alignment.hasRows =
        estimateRows(buffers.coarse, search.finestLayer, search.maxRowOffset, alignment.rows, alignment.noise);
    if (search.hasLight && isGrey)
        alignment.hasLight = estimateLight(buffers.coarse, alignment.light);

    Mat& finest = images[search.finestLayer].right;
    if (alignment.hasRows)
    {
        alignRows(finest, alignment.rows.ofLayer(search.finestLayer), buffers.right);
        finest = buffers.right;
    }
    if (alignment.hasLight)
        alignLight(finest, alignment.light);
    if (alignment.hasRows || alignment.hasLight)
        for (size_t layer = search.finestLayer + 1; layer < images.size(); ++layer)
            halveImage(images[layer - 1].right, images[layer].right); // into the memory of the pyramid

    alignment.isNoisy = search.noiseThreshold > 0 && alignment.noise.deviation >= search.noiseThreshold;
    if (!alignment.isNoisy || !isGrey)
        return;
    buffers.smoothed.resize(images.size());
    for (size_t layer = search.finestLayer; layer < images.size(); ++layer)
        smooth(images[layer], buffers.smoothed[layer]);
}

}}} // namespace cv::stereo::hdp
