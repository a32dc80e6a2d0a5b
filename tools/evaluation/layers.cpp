// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "layers.hpp"

namespace hdp_tools {

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

} // namespace hdp_tools
