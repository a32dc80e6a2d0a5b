// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches the scenes of datasets with several methods.

#ifndef OPENCV_HDPSTEREO_TOOLS_EVALUATION_HPP
#define OPENCV_HDPSTEREO_TOOLS_EVALUATION_HPP

#include <functional>
#include <set>
#include <vector>

#include "datasets.hpp"
#include "harmless_changes.hpp"
#include "methods.hpp"
#include "scores.hpp"

namespace hdp_tools {

//! Of a method on a scene
struct Result
{
    bool done;
    Score score;
    double seconds;
    std::vector<double> ratios; // R_l of an HDPTreeMatcher, by layer

    Result() : done(false), seconds(NO_SCORE) {}
};

struct SceneResult
{
    Scene scene;
    bool isRead;
    Pair::Protocol protocol;
    cv::Size size;
    std::vector<Result> results; // by method
    String maps, predictions;    // figures of the report
    std::vector<String> problems;

    SceneResult(const Scene& scene_, size_t methods)
        : scene(scene_), isRead(false), protocol(Pair::NO_TRUTH), results(methods)
    {
    }
};

struct EvaluationSettings
{
    std::vector<Method> methods;
    int numDisparities;                  // 0: the dataset's
    int runs;                            // of which the shortest time counts
    int jobs;                            // pairs that are matched at a time
    String maps;                         // folder for METHOD/SET/SCENE.png, or empty
    bool hasReport;                      // makes the figures
    std::vector<HarmlessChange> changes; // over which all figures are means; if empty, they are of the pair as it is
};

/** Calls use with each scene and its pair, for tables of one method. What goes wrong is told, as by evaluateScenes(), and
the scene is left out. Ends early if interrupted.
@param bad Receives the titles of what is left out. */
void forEachPair(const Method& method, const std::vector<Scene>& scenes, std::set<String>& bad,
                 const std::function<void(const Scene&, const Pair&)>& use);

//! Makes a folder and those above it; fails if it cannot.
void makeFolder(const String& path);

//! Fills the results; what goes wrong becomes a problem of its scene. Returns how many scenes have problems.
int evaluateScenes(const EvaluationSettings& settings, std::vector<SceneResult>& results);

} // namespace hdp_tools

#endif
