// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "pair_alignment.hpp"

#include "../base/vectorized.hpp"
#include "image_pyramid.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

HDP_TUNABLE(double, smoothingPerLevel, 32, "1/256 per grey level",
            "weight of a pixel's neighbour by the noise above the threshold: more loses texture, less keeps noise");

//! See greyLevels().
bool hasGreyLevels(const std::vector<LayerImages>& images) { return images[0].right.depth() == CV_16U; }

void findAlignment(const AlignmentPlan& plan, AlignmentBuffers& buffers, const std::vector<LayerImages>& images,
                   PairFindings& findings)
{
    std::vector<Mat> left, right;
    for (const LayerImages& layer : images)
    {
        left.push_back(layer.left);
        right.push_back(layer.right);
    }
    if (!hasGreyLevels(images))
    {
        greyLevels(images[0].left, LevelScale(), buffers.leftLevels);
        greyLevels(images[0].right, LevelScale(), buffers.rightLevels);
        left.assign(1, buffers.leftLevels);
        right.assign(1, buffers.rightLevels);
    }
    matchCoarsely(left, right, images[0].masks, Range(0, plan.numDisparities), plan.maxRowOffset, 0, buffers.coarse);
    estimateRows(buffers.coarse, plan.finestLayer, plan.maxRowOffset, findings);
    if (plan.findsLight && hasGreyLevels(images))
        findings.hasLight = estimateLight(buffers.coarse, findings.light);
}

//! A row of smoothNoise(). columns: memory, and one more element at both ends
void smoothRow(const ushort* above, const ushort* own, const ushort* below, int width, int neighbour, int* columns,
               ushort* smoothed)
{
    const int middle = 256 - 2 * neighbour;
    HDP_VECTORIZED for (int x = 0; x < width; ++x) columns[x] = middle * own[x] + neighbour * (above[x] + below[x]);
    columns[-1] = columns[0];
    columns[width] = columns[width - 1];
    HDP_VECTORIZED for (int x = 0; x < width; ++x) smoothed[x] =
        (ushort)((middle * columns[x] + neighbour * (columns[x - 1] + columns[x + 1]) + (1 << 15)) >> 16);
}

} // namespace

double AlignmentPlan::excessNoise(const LayerNoise& noise) const
{
    return noiseThreshold > 0 ? std::max(noise.ofLayer(finestLayer) - noiseThreshold, 0.) : 0;
}

int AlignmentPlan::smoothing(const LayerNoise& noise) const
{
    return (int)std::min(smoothingPerLevel * excessNoise(noise), (double)mostSmoothing);
}

void smoothNoise(const Mat& image, int neighbour, Mat& smoothed)
{
    smoothed.create(image.size(), CV_16U);
    parallelForRows(image.size(), std::vector<int>(image.cols + 2), [&](int y, std::vector<int>& columns) {
        smoothRow(image.ptr<ushort>(std::max(y - 1, 0)), image.ptr<ushort>(y),
                  image.ptr<ushort>(std::min(y + 1, image.rows - 1)), image.cols, neighbour, &columns[1],
                  smoothed.ptr<ushort>(y));
    });
}

void alignPair(const AlignmentPlan& plan, AlignmentBuffers& buffers, std::vector<LayerImages>& images,
               PairFindings& findings, const GivenPair& given)
{
    findings = given.findings;
    if (!given.isGiven)
        findAlignment(plan, buffers, images, findings);
    findings.hasLight &= hasGreyLevels(images);
    const ImageFrame frame =
        (given.isGiven ? given.frame : ImageFrame(images[0].guide.size())).ofLayer(plan.finestLayer);

    Mat &finest = images[plan.finestLayer].right, &mask = images[plan.finestLayer].masks.right;
    if (findings.hasRows)
    {
        const RowModel rows = findings.rows.ofLayer(plan.finestLayer);
        alignRows(finest, rows, frame, buffers.right);
        finest = buffers.right;
        alignRows(mask, rows, frame, buffers.mask); // levels that are mixed from both have data if half of them does
        mask = buffers.mask;
    }
    if (findings.hasLight)
        alignLight(finest, findings.light, frame);
    if (findings.hasRows || findings.hasLight)
        for (size_t layer = plan.finestLayer + 1; layer < images.size(); ++layer) // into the memory of the pyramids
        {
            halveImage(images[layer - 1].right, images[layer].right);
            halveImage(images[layer - 1].masks.right, images[layer].masks.right);
        }

    const int neighbour = plan.smoothing(findings.noise);
    if (!hasGreyLevels(images) || neighbour == 0)
        return;
    buffers.smoothed.resize(images.size());
    for (size_t layer = plan.finestLayer; layer < images.size(); ++layer)
    {
        LayerImages& smoothed = buffers.smoothed[layer];
        smoothNoise(images[layer].left, neighbour, smoothed.left);
        smoothNoise(images[layer].right, neighbour, smoothed.right);
        images[layer].left = smoothed.left;
        images[layer].right = smoothed.right;
    }
}

}}} // namespace cv::stereo::hdp
