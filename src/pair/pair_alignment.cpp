// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "pair_alignment.hpp"

#include "image_levels.hpp"
#include "image_pyramid.hpp"
#include "noise_smoothing.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

void smooth(LayerImages& images, LayerImages& smoothed)
{
    smoothNoise(images.left, smoothed.left);
    smoothNoise(images.right, smoothed.right);
    images.left = smoothed.left;
    images.right = smoothed.right;
}

bool isGrey(const std::vector<LayerImages>& images) { return images[0].right.depth() == CV_16U; } // see greyLevels()

//! The right masks from the finest layer on; levels that are mixed from both have data if half of them does.
void alignMask(const RowModel& model, const ImageFrame& frame, int finestLayer, std::vector<LayerImages>& images)
{
    Mat aligned;
    alignRows(images[finestLayer].masks.right, model, frame, aligned);
    std::vector<Mat> masks;
    buildPyramid({ aligned }, images.size() - finestLayer, masks);
    for (size_t i = 0; i < masks.size(); ++i)
        images[finestLayer + i].masks.right = masks[i];
}

void findAlignment(const AlignmentPlan& plan, AlignmentBuffers& buffers, const std::vector<LayerImages>& images,
                   PairFindings& findings)
{
    std::vector<Mat> left, right;
    if (isGrey(images))
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
    matchCoarsely(left, right, images[0].masks, Range(0, plan.numDisparities), buffers.coarse);
    estimateRows(buffers.coarse, plan.finestLayer, plan.maxRowOffset, findings);
    if (plan.findsLight && isGrey(images))
        findings.hasLight = estimateLight(buffers.coarse, findings.light);
}

} // namespace

void alignPair(const AlignmentPlan& plan, AlignmentBuffers& buffers, std::vector<LayerImages>& images,
               PairFindings& findings, const GivenAlignment* given)
{
    findings = given ? given->findings : PairFindings();
    if (!given)
        findAlignment(plan, buffers, images, findings);
    findings.hasLight &= isGrey(images);
    const ImageFrame frame = (given ? given->frame : ImageFrame(images[0].guide.size())).ofLayer(plan.finestLayer);

    Mat& finest = images[plan.finestLayer].right;
    if (findings.hasRows)
    {
        alignRows(finest, findings.rows.ofLayer(plan.finestLayer), frame, buffers.right);
        finest = buffers.right;
        if (!images[0].masks.isEmpty())
            alignMask(findings.rows.ofLayer(plan.finestLayer), frame, plan.finestLayer, images);
    }
    if (findings.hasLight)
        alignLight(finest, findings.light, frame);
    if (findings.hasRows || findings.hasLight)
        for (size_t layer = plan.finestLayer + 1; layer < images.size(); ++layer)
            halveImage(images[layer - 1].right, images[layer].right); // into the memory of the pyramid

    if (!isGrey(images) || !plan.isNoisy(findings.noise))
        return;
    buffers.smoothed.resize(images.size());
    for (size_t layer = plan.finestLayer; layer < images.size(); ++layer)
        smooth(images[layer], buffers.smoothed[layer]);
}

}}} // namespace cv::stereo::hdp
