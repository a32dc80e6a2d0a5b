// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// A TreeStrategy of one's own, in comparison with the minimum spanning tree: the errors of both on a rectified pair.

#include <iostream>

#include "hdp_samples_common.hpp"

using namespace cv;
using namespace hdp_samples;
using cv::stereo::HDPTreeMatcher;

//! [class]
//! Edges by ascending weight, as in a minimum spanning tree, but no tree goes across an edge of a larger weight: costs
//! are only shared inside a region that no strong contour cuts.
class ContourTree : public stereo::TreeStrategy
{
public:
    explicit ContourTree(int maxWeight = 20) : maxWeight_(maxWeight) {}

    //! [rule1]
    void orderEdges(const Mat& weights, std::vector<int>& edges) const CV_OVERRIDE
    {
        const uchar* weight = weights.ptr(); // the matrix is continuous: edge e has weight[e]
        std::stable_sort(edges.begin(), edges.end(), [weight](int a, int b) { return weight[a] < weight[b]; });
    }
    //! [rule1]

    //! [rule2]
    bool mayJoin(int weight, const stereo::TreeState&, const stereo::TreeState&) const CV_OVERRIDE
    {
        return weight <= maxWeight_;
    }
    //! [rule2]

    //! [storage]
    String getDefaultName() const CV_OVERRIDE { return "samples_ContourTree"; }
    void write(FileStorage& fs) const CV_OVERRIDE { fs << "maxWeight" << maxWeight_; }
    //! [storage]

private:
    int maxWeight_;
};
//! [class]

static const char* const KEYS =
    "{help h ?        |    | print this and exit }"
    "{@left           |    | left image of a rectified pair }"
    "{@right          |    | right image }"
    "{min-disparity   | 0  | smallest disparity in pixels }"
    "{num-disparities |    | number of disparities; by default width / 5, rounded up to a multiple of 16 }"
    "{max-weight      | 20 | largest weight of an edge of a tree, 0..255 }"
    "{truth           |    | left disparity: PNG of 8 bit (0 = unknown) or 16 bit (times 256, 0 = unknown) or PFM }"
    "{truth-right     |    | right disparity; occluded pixels are then not judged }"
    "{truth-scale     |    | what a disparity of 1 is in the truth files, if not 1 (8 bit, PFM) or 256 (16 bit) }";

static const std::vector<String> FLAGS = { "help", "h", "?" };

static void run(const CommandLineParser& parser)
{
    Mat left, right;
    readPair(parser, left, right);
    const Truth truth = readTruth(parser, left.size());
    const Range disparities = getDisparities(parser, left.size());
    const int maxWeight = getInteger(parser, "max-weight", 0, 255);

    //! [use]
    const Ptr<HDPTreeMatcher> matcher =
        HDPTreeMatcher::create(disparities.start, disparities.size(), HDPTreeMatcher::PRESET_TREE);
    const Ptr<stereo::TreeStrategy> strategies[] = { stereo::createMinimumSpanningTree(),
                                                     makePtr<ContourTree>(maxWeight) };
    for (const Ptr<stereo::TreeStrategy>& strategy : strategies)
    {
        matcher->setTreeStrategy(strategy);
        Mat disparity, trees, intervals;
        matcher->compute(left, right, disparity);
        matcher->getForest(trees, intervals); // of the image itself
        //! [use]
        double lastTree;
        minMaxLoc(trees, nullptr, &lastTree);
        std::cout << format("%-30s%10.0f trees", strategy->getDefaultName().c_str(), lastTree + 1);
        if (!truth.disparity.empty())
        {
            const Mat map = toPixels(disparity, matcher->getMinDisparity());
            for (int threshold = 1; threshold <= 2; threshold++)
                std::cout << format("   err>=%d %6.2f %%", threshold,
                                    percent(wrongPixels(map, truth.disparity, truth.judged, threshold), truth.judged));
        }
        std::cout << std::endl;
    }
}

int main(int argc, char** argv)
{
    return runSample(argc, argv, KEYS, "A TreeStrategy of one's own, beside the minimum spanning tree.\n", FLAGS, 2,
                     run);
}
