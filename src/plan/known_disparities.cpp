// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "known_disparities.hpp"

#include "../pair/image_pyramid.hpp"

namespace cv { namespace stereo { namespace hdp {

void takeKnown(const PairInputs& inputs, const PairPlan& plan, KnownDisparities& known)
{
    const OutputPlan& output = plan.output;
    const int first = output.minDisparity, numDisparities = plan.alignment.numDisparities;
    const Range disparities(first, first + numDisparities - 1);
    std::vector<int> counts;
    for (int layer = 0; layer <= plan.top().layer; ++layer)
        counts.push_back(layerDisparities(numDisparities, layer, plan.top().hasFractions));
    expandRanges(inputs.smallest, inputs.largest, plan.size, disparities, output.isWhole, known.ranges);
    buildIntervals(known.ranges, first, output.extension, counts, known.units, known.intervals);
    known.points.resize(counts.size());
    for (const LayerPlan& layer : plan.layers)
        if (layer.joinsPrior)
            pointsOfLayer(inputs.prior, inputs.sigma, first, output.extension, layer.layer, counts[layer.layer],
                          known.points[layer.layer]);
}

}}} // namespace cv::stereo::hdp
