// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "layers.hpp"

#include <algorithm>

#include "opencv2/imgproc.hpp"

#include "command_line.hpp"

namespace hdp_tools {

Mat nextLayer(const Mat& image)
{
    const cv::Size size(image.cols / 2, image.rows / 2);
    if (size.empty())
        fail(cv::format("an image of %d x %d pixels has no more layers", image.cols, image.rows));
    Mat next;
    cv::resize(image(cv::Rect(0, 0, size.width * 2, size.height * 2)), next, size, 0, 0, cv::INTER_AREA);
    return next;
}

Mat truthOfLayer(const Mat& truth, int layer)
{
    Mat result = truth;
    for (int l = 0; l < layer; l++)
    {
        Mat next(result.rows / 2, result.cols / 2, CV_32F);
        for (int y = 0; y < next.rows; y++)
            for (int x = 0; x < next.cols; x++)
                next.at<float>(y, x) = result.at<float>(2 * y, 2 * x) / 2; // NO_DISPARITY stays
        result = next;
    }
    return result;
}

Ptr<DisparityPredictionModel> publishedModel(int width)
{
    return DisparityPredictionModel::createPublished(width >= 1000 ? DisparityPredictionModel::PUBLISHED_LARGE
                                                                   : DisparityPredictionModel::PUBLISHED_SMALL);
}

Ptr<DisparityPredictionModel> upperPart(const DisparityPredictionModel& model, int first)
{
    const Ptr<DisparityPredictionModel> part = DisparityPredictionModel::create();
    for (int layer = first; layer < model.getNumLayers(); layer++)
    {
        std::vector<double> means, sigmas, weights;
        model.getLayer(layer, means, sigmas, weights);
        part->addLayer(means, sigmas, weights);
    }
    return part;
}

int disparitiesOfLayer(int numDisparities, int layer) { return ((numDisparities - 1) >> layer) + 1; }

void adaptToLayer(HDPTreeMatcher& matcher, int layer, int layers, int width, const Ptr<DisparityPredictionModel>& above)
{
    const bool isLarge = width >= 1000; // see HDPTreeMatcher::setDelta0() and setBeta()
    if (matcher.getDelta0() == HDPTreeMatcher::AUTO)
        matcher.setDelta0(isLarge ? 0.064 : 0.004);
    if (matcher.getBeta() == HDPTreeMatcher::AUTO)
        matcher.setBeta(isLarge ? 0.6 : 0.95);
    matcher.setDelta0(std::min(matcher.getDelta0() * (1 << layer), 0.999));
    matcher.setNumLayers(layers - layer);
    matcher.setPredictionModel(above);
}

Ptr<HDPTreeMatcher> matcherOfLayer(int layer, int layers, int numDisparities, int width,
                                   const Ptr<DisparityPredictionModel>& above)
{
    const Ptr<HDPTreeMatcher> matcher =
        HDPTreeMatcher::create(0, disparitiesOfLayer(numDisparities, layer), HDPTreeMatcher::PRESET_PAPER);
    adaptToLayer(*matcher, layer, layers, width, above);
    return matcher;
}

} // namespace hdp_tools
