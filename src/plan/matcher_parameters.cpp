// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "matcher_parameters.hpp"

#include "../scanlines/candidate_windows.hpp"
#include "../map/disparity_output.hpp"
#include "../pair/image_pyramid.hpp"
#include "../pair/pair_pyramids.hpp"

namespace cv { namespace stereo { namespace hdp {

namespace {

typedef HDPTreeMatcher M;

// Between Middlebury's full and half size, for which the authors' program has values of its own.
const int largeImageWidth = 1000;

const int leastTopDisparities = CandidateWindow::candidates; // of more than two layers
const int largestWindow = 31;                                // that a cost is averaged over

//! The side of the matching cost's window. Values that are not odd and positive count as with cv::StereoSGBM.
int windowSide(const MatcherParameters& p)
{
    const int side = p.blockSize > 0 ? p.blockSize / 2 * 2 + 1 : 5;
    return p.matchingCost == M::COST_CENSUS ? std::min(std::max(side, 3), 7) : std::min(side, largestWindow);
}

//! Of parameters alone, and of the image's size
void checkCombinations(const MatcherParameters& p, Size size)
{
    const int64 lowest = ((int64)p.minDisparity - 1) * M::DISP_SCALE;
    const int64 highest = ((int64)p.minDisparity + p.numDisparities - 1) * M::DISP_SCALE;
    if (lowest < SHRT_MIN || highest > SHRT_MAX)
        CV_Error(Error::StsOutOfRange, format("minDisparity and numDisparities must keep (minDisparity - 1) * %d and "
                                              "(minDisparity + numDisparities - 1) * %d in CV_16S",
                                              (int)M::DISP_SCALE, (int)M::DISP_SCALE));

    if (p.aggregation != M::AGGREGATION_TREES && p.matchingCost != M::COST_CENSUS)
        CV_Error(Error::StsBadArg, format("matchingCost must be COST_CENSUS for AGGREGATION_%sSCANLINES",
                                          p.aggregation == M::AGGREGATION_SCANLINES ? "" : "TREE_"));

    if (p.fillOcclusions && p.matchingCost != M::COST_CENSUS)
        CV_Error(Error::StsBadArg, "matchingCost must be COST_CENSUS for fillOcclusions");

    if (p.useTemporalPrediction && p.matchingCost != M::COST_CENSUS)
        CV_Error(Error::StsBadArg, "matchingCost must be COST_CENSUS for useTemporalPrediction");

    if (p.speckleWindowSize > 0 && size.area() > INT_MAX / speckleBytes)
        CV_Error(Error::StsOutOfRange,
                 format("speckleWindowSize must be <= 0 for images of more than %d pixels", INT_MAX / speckleBytes));
}

} // namespace

int chooseLayers(int numDisparities, int numLayers, int maxTopDisparities, int mostLayers)
{
    if (maxTopDisparities == 0)
        return numLayers;
    int layers = numLayers;
    const auto topDisparities = [&](int count) { return layerDisparities(numDisparities, count - 1, false); };
    while (layers > 2 && topDisparities(layers) < leastTopDisparities)
        --layers;
    while (layers < mostLayers && topDisparities(layers) > maxTopDisparities &&
           topDisparities(layers + 1) >= leastTopDisparities)
        ++layers;
    return layers;
}

PairSettings resolve(const MatcherParameters& p, const Mat& left)
{
    const Size size = left.size();
    checkCombinations(p, size);
    PairSettings settings;
    const bool isLarge = size.width >= largeImageWidth;
    settings.model = p.predictionModel;
    if (!settings.model)
        settings.model = DisparityPredictionModel::createPublished(isLarge ? DisparityPredictionModel::PUBLISHED_LARGE
                                                                           : DisparityPredictionModel::PUBLISHED_SMALL);
    const bool predictsIntervals = p.aggregation != M::AGGREGATION_SCANLINES;
    const int mostLayers = predictsIntervals ? settings.model->getNumLayers() + 1 : INT_MAX;
    const int layers = chooseLayers(p.numDisparities, p.numLayers, p.maxTopDisparities, mostLayers);
    settings.layers = p.usePrediction ? countLayers(size, layers) : 1;
    settings.finestLayer = std::min(p.finestLayer, settings.layers - 1);
    settings.windowSide = windowSide(p);
    const int missing =
        std::min(-p.minDisparity, p.numDisparities); // columns that the first ones have their matches in
    settings.extension = missing > 0 ? (int)alignSize(missing, 1 << (settings.layers - 1)) : 0;
    const int64 width = (int64)size.width + settings.extension;
    if (width > maxSide || width * size.height * (int64)left.elemSize() > INT_MAX)
        CV_Error(Error::StsOutOfRange,
                 format("minDisparity must not be %d for an image of %d x %d: %d columns are added to it",
                        p.minDisparity, size.width, size.height, settings.extension));
    settings.subpixel = p.useSubpixel || p.aggregation != M::AGGREGATION_TREES;

    if (predictsIntervals && settings.model->getNumLayers() < settings.layers - 1)
        CV_Error(Error::StsOutOfRange, format("predictionModel must have numLayers - 1 = %d layers, not %d",
                                              settings.layers - 1, settings.model->getNumLayers()));
    // The values of the authors' program; the paper's text has those of large and of small images the other way round.
    settings.delta0 = p.delta0 != M::AUTO ? p.delta0 : isLarge ? 0.064 : 0.004;
    settings.beta = p.beta != M::AUTO ? p.beta : isLarge ? 0.6 : 0.95;
    // As in the authors' program; the paper says that nothing is refined.
    settings.medianSize = p.disparityMedianSize != M::AUTO ? p.disparityMedianSize : p.usePrediction ? 7 : 5;
    return settings;
}

}}} // namespace cv::stereo::hdp
