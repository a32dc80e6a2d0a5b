// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// A TreeStrategy of one's own, in comparison with the minimum spanning tree: the errors of both on a rectified pair.

#include "strict_arguments.hpp"

#include <algorithm>
#include <iostream>

#include "opencv2/core/utility.hpp"
#include "opencv2/core/utils/logger.hpp"
#include "opencv2/hdpstereo.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

using namespace cv;
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
    //! [order]
    bool ordersByWeight() const CV_OVERRIDE { return true; }
    //! [order]

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

static const char* const keys = "{help h ?        |     | print this and exit }"
                                "{@left           |     | left image of a rectified pair, of 8 or 16 bit }"
                                "{@right          |     | right image }"
                                "{num-disparities | 128 | number of disparities, from 0 }"
                                "{max-weight      | 20  | largest weight of an edge of a tree, 0..255 }"
                                "{truth           |     | true disparities, 8 bit, 0 = unknown }";

static Mat readImage(const String& path, int flags)
{
    const Mat image = imread(path, flags);
    if (image.empty())
        CV_Error(Error::StsError, "cannot read the image '" + path + "'");
    return image;
}

//! Colours in 8 bit, or grey levels in 16 bit of a picture that has them
static Mat readPicture(const String& path)
{
    Mat image = readImage(path, IMREAD_COLOR | IMREAD_ANYDEPTH);
    if (image.depth() == CV_16U)
        cvtColor(image, image, COLOR_BGR2GRAY);
    return image;
}

//! Prints the share of the pixels of known truth that are wrong.
static void printErrors(const Mat& disparity16, const Mat& truth)
{
    Mat truth16;
    truth.convertTo(truth16, CV_16S, StereoMatcher::DISP_SCALE);
    const Mat error = abs(disparity16 - truth16);
    for (int threshold = 1; threshold <= 2; threshold++)
    {
        const Mat wrong = (error >= threshold * StereoMatcher::DISP_SCALE) & (truth != 0);
        std::cout << format("   err>=%d %6.2f %%", threshold, 100. * countNonZero(wrong) / countNonZero(truth));
    }
}

static void run(const CommandLineParser& parser)
{
    const Mat left = readPicture(parser.get<String>("@left")), right = readPicture(parser.get<String>("@right")),
              truth = parser.has("truth") ? readImage(parser.get<String>("truth"), IMREAD_GRAYSCALE) : Mat();
    const int numDisparities = hdp_samples::integerOf(parser, "num-disparities", 0, 2047),
              maxWeight = hdp_samples::integerOf(parser, "max-weight", 0, 255);
    if (!truth.empty() && truth.size() != left.size())
        CV_Error(Error::StsUnmatchedSizes, "--truth must have the size of the images");

    //! [use]
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(0, numDisparities, HDPTreeMatcher::PRESET_TREE);
    const Ptr<stereo::TreeStrategy> strategies[] = { stereo::createMinimumSpanningTree(),
                                                     makePtr<ContourTree>(maxWeight) };
    for (const Ptr<stereo::TreeStrategy>& strategy : strategies)
    {
        matcher->setTreeStrategy(strategy);
        Mat disparity, trees, intervals;
        matcher->compute(left, right, disparity);
        matcher->getForest(trees, intervals); // of the top layer, which has the trees
        //! [use]
        double lastTree;
        minMaxLoc(trees, nullptr, &lastTree);
        std::cout << format("%-30s%10.0f trees", strategy->getDefaultName().c_str(), lastTree + 1);
        if (!truth.empty())
            printErrors(disparity, truth);
        std::cout << std::endl;
    }
    if (!std::cout)
        CV_Error(Error::StsError, "cannot write to the standard output");
}

int main(int argc, char** argv)
{
    utils::logging::setLogLevel(utils::logging::LOG_LEVEL_SILENT); // errors are reported below
    CommandLineParser parser(argc, argv, keys);
    parser.about("A TreeStrategy of one's own, beside the minimum spanning tree.");
    if (parser.has("help"))
    {
        parser.printMessage();
        return 0;
    }
    try
    {
        hdp_samples::checkArguments(argc, argv, parser, 2);
        run(parser);
    }
    catch (const cv::Exception& e)
    {
        std::cerr << "error: " << e.err << std::endl;
        return 1;
    }
    return 0;
}
