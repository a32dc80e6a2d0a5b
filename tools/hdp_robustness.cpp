// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches every pair of a dataset as it is and as less than ideal cameras would have taken it: other light, noise, blur,
// compression, and rows that do not fit.

#include <iostream>

#include "evaluation/bad_cameras.hpp"
#include "evaluation/command_line.hpp"
#include "evaluation/datasets.hpp"
#include "evaluation/methods.hpp"
#include "evaluation/progress.hpp"
#include "evaluation/scores.hpp"
#include "evaluation/tables.hpp"
#include "evaluation/tunables.hpp"

#include "opencv2/imgproc.hpp"

using namespace cv;
using namespace hdp_tools;

static const String KEYS =
    String("{help h ?        |     | print this and exit }"
           "{@root           |     | folder of Middlebury, ETH3D or KITTI pairs, or of such folders }"
           "{resolution      |     | only these of Middlebury's: full, half, third or quarter, separated by commas }"
           "{scenes          |     | only these, separated by commas }"
           "{methods         | fast,quality,ultrafast,tree,sgbm-3way,sgbm-hh4 | names as of hdp_evaluate }"
           "{cases           | ") +
    ALL_CASES +
    " | changes of the pairs; numbers may be others }"
    "{num-disparities |     | number of disparities; by default that of the dataset }"
    "{threads         |     | number of threads; all processors if not given }";

//! Of the pairs of a set, by case and method
typedef std::vector<std::vector<std::vector<double>>> Scores;

static Table toTable(const String& set, Pair::Protocol protocol, size_t pairs, const std::vector<CameraCase>& cases,
                     const std::vector<Method>& methods, const Scores& scores)
{
    Table table;
    table.title = set + ": " + mainScoreName(protocol) + format(", means of %d pairs", (int)pairs);
    table.header.push_back("case");
    for (const Method& method : methods)
        table.header.push_back(method.name);
    for (size_t i = 0; i < cases.size(); ++i)
    {
        std::vector<double> means;
        for (const std::vector<double>& ofMethod : scores[i])
            means.push_back(meanOf(ofMethod));
        table.addRow(cases[i].name);
        table.addNumbers(means);
    }
    return table;
}

//! Judges the pixels that both images of a case show, but for two at the ends of what is blank, which resampling mixes
//! from both.
static void judgeShown(const CameraCase& made, Pair& pair)
{
    if (!made.shownLeft)
        return;
    const int mixed = 2;
    Mat shown, right;
    erode(made.shownLeft(pair.truth.size()), shown, Mat(), Point(-1, -1), mixed);
    erode(made.shownRight(pair.truth.size()), right, Mat(), Point(-1, -1), mixed);
    for (int y = 0; y < shown.rows; ++y)
        for (int x = 0; x < shown.cols; ++x)
        {
            const float disparity = pair.truth.at<float>(y, x);
            const double column = disparity == NO_DISPARITY ? -1. : x - (double)disparity;
            if (!(column >= 0 && column < right.cols && right.at<uchar>(y, (int)column)))
                shown.at<uchar>(y, x) = 0;
        }
    for (Mat* judged : { &pair.judged, &pair.judgedNonOccluded })
        if (!judged->empty())
            *judged = Mat(*judged & shown); // not in place: other cases judge the same pixels
}

static int run(const CommandLineParser& parser)
{
    if (useTunables(parser))
        return 0;
    if (!parser.has("@root"))
        fail("a folder is needed, see --help");
    setThreads(parser);
    const std::vector<Method> methods = selectMethods("methods", parser.get<String>("methods"));
    const std::vector<CameraCase> cases = selectCases("cases", parser.get<String>("cases"));
    const int numDisparities = parser.has("num-disparities") ? getInteger(parser, "num-disparities", 1, 2048) : 0;
    const std::vector<Scene> scenes = selectScenes(parser);
    catchInterrupts();
    Progress progress(scenes.size());
    size_t skipped = 0;
    for (size_t first = 0, next; first < scenes.size() && !isInterrupted(); first = next)
    {
        // The scenes of a set
        for (next = first; next < scenes.size() && scenes[next].set == scenes[first].set; ++next)
            ;
        Scores scores(cases.size(), std::vector<std::vector<double>>(methods.size()));
        Pair::Protocol protocol = Pair::NO_TRUTH;
        size_t pairs = 0;
        for (size_t s = first; s < next && !isInterrupted(); ++s)
        {
            Pair pair;
            try
            {
                pair = readPair(scenes[s]);
                if (pair.protocol == Pair::NO_TRUTH)
                    fail("has no truth");
                if (pairs > 0)
                    expectProtocol(pair, protocol);
            }
            catch (const std::exception& error)
            {
                progress.message("skipped " + scenes[s].title() + ": " + messageOf(error));
                progress.skip(1);
                ++skipped;
                continue;
            }
            toColors(pair.left, pair.right);
            protocol = pair.protocol;
            ++pairs;
            if (numDisparities > 0)
                pair.disparities.end = pair.disparities.start + numDisparities;
            for (size_t i = 0; i < cases.size(); ++i)
            {
                RNG rng(s - first + 1); // every method gets the same noise
                const Mat left = cases[i].left(pair.left, rng), right = cases[i].right(pair.right, rng);
                Pair judged = pair;
                judgeShown(cases[i], judged);
                for (size_t m = 0; m < methods.size(); ++m)
                {
                    const Ptr<StereoMatcher> matcher = methods[m].create(pair.disparities);
                    const std::array<Mat, 2> images = imagesFor(methods[m], left, right);
                    const Mat disparity = matchDensely(methods[m], *matcher, images[0], images[1]);
                    scores[i][m].push_back(mainScore(scoreMap(disparity, judged), protocol));
                }
            }
            progress.step(scenes[s].title());
        }
        if (pairs > 0)
            std::cout << toMarkdown(toTable(scenes[first].set, protocol, pairs, cases, methods, scores)) << std::endl;
    }
    progress.finish();
    return endOfRun(skipped, scenes.size());
}

int main(int argc, char** argv)
{
    return runProgram(
        argc, argv, KEYS + TUNABLE_KEYS,
        "Errors of stereo matchers when the cameras are not ideal: light, noise, blur, rows.\n"
        "Exit status: 0 if all is well, 2 if a pair was skipped, 130 if interrupted, 1 on other errors.\n",
        {}, 1, run);
}
