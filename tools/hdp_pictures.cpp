// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Makes the pictures of the README and the tutorial, from a rectified pair with truth: what the stages of HDPTreeMatcher
// give, and StereoSGBM beside them.

#include <iostream>

#include "opencv2/imgproc.hpp"

#include "evaluation/command_line.hpp"
#include "evaluation/methods.hpp"
#include "evaluation/pictures.hpp"

using namespace cv;
using namespace hdp_tools;

static const String KEYS = "{help h ?        |     | print this and exit }" + String(PAIR_KEYS) +
                           "{output          | .   | folder for the pictures }"
                           "{width           | 400 | width of each of the pictures that are put side by side }";

//! Pictures side by side, of a width each
static Mat sideBySide(const std::vector<Mat>& pictures, int width, int interpolation)
{
    std::vector<Mat> resized;
    for (const Mat& picture : pictures)
    {
        Mat scaled;
        resize(picture, scaled, Size(width, cvRound((double)picture.rows * width / picture.cols)), 0, 0, interpolation);
        copyMakeBorder(scaled, scaled, 0, 0, resized.empty() ? 0 : 4, 0, BORDER_CONSTANT, Scalar::all(255));
        resized.push_back(scaled);
    }
    Mat row;
    hconcat(resized, row);
    return row;
}

static Mat withErrors(const Mat& disparity, const Pair& pair, const Vec2f& range)
{
    Mat picture = colorPicture(disparity, range);
    picture.setTo(Scalar::all(0), ~pair.judged);
    picture.setTo(Scalar(0, 0, 255), wrongPixels(disparity, pair));
    return picture;
}

static int run(const CommandLineParser& parser)
{
    const Pair pair = readPair(parser);
    if (pair.truth.empty())
        fail("--truth is needed");
    Mat left = pair.left, right = pair.right;
    toColors(left, right);
    const int width = getInteger(parser, "width", 16, 4096);
    const Vec2f range = colorRange(pair.truth);

    const auto create = [&](int preset) {
        return HDPTreeMatcher::create(pair.disparities.start, pair.disparities.size(), preset);
    };
    const auto match = [&](HDPTreeMatcher& matcher) {
        Mat disparity;
        matcher.compute(pair.left, pair.right, disparity);
        return toPixels(disparity, pair.disparities.start);
    };
    const auto save = [&](const String& name, const std::vector<Mat>& pictures, int interpolation) {
        const String path = parser.get<String>("output") + "/hdpstereo_" + name;
        writeImage(path, sideBySide(pictures, width, interpolation));
        std::cout << "written    " << path << std::endl;
    };

    const Method sgbm = selectMethods("", "sgbm-3way")[0];
    const Mat ofSgbm = matchDensely(sgbm, *sgbm.create(pair.disparities), pair.left, pair.right);
    const Mat ofFast = match(*create(HDPTreeMatcher::PRESET_FAST));
    save("sgbm.jpg", { left, colorPicture(ofSgbm, range), colorPicture(ofFast, range) }, INTER_AREA);

    save("pair.jpg", { left, right, colorPicture(pair.truth, range) }, INTER_AREA);

    const Ptr<HDPTreeMatcher> paper = create(HDPTreeMatcher::PRESET_PAPER), fast = create(HDPTreeMatcher::PRESET_FAST);
    for (const Ptr<HDPTreeMatcher>& matcher : { paper, fast })
    {
        std::vector<Mat> maps;
        for (int layer = 2; layer >= 0; layer--) // both have at least 3 of them
        {
            HDPTreeMatcher::Params params = matcher->getParams();
            params.finestLayer = layer;
            matcher->setParams(params);
            maps.push_back(colorPicture(match(*matcher), range));
        }
        save(matcher == paper ? "layers_paper.jpg" : "layers_fast.jpg", maps, INTER_AREA);
    }

    match(*paper);
    Mat trees, intervals;
    paper->getForest(trees, intervals);
    save("forest.png", { forestPicture(trees), widthPicture(intervals, 16) }, INTER_NEAREST);

    match(*fast);
    Mat confidence;
    fast->getConfidence(confidence);
    cvtColor(confidence, confidence, COLOR_GRAY2BGR);
    save("confidence.jpg", { colorPicture(ofFast, range), withErrors(ofFast, pair, range), confidence }, INTER_AREA);

    HDPTreeMatcher::Params params;
    params.fillOcclusions = false;
    fast->setParams(params);
    save("occlusions.jpg", { colorPicture(match(*fast), range), colorPicture(ofFast, range) }, INTER_AREA);

    // The pair as a video of a scene that stands still, with noise of its own in each frame
    const Ptr<HDPTreeMatcher> single = create(HDPTreeMatcher::PRESET_FAST), video = create(HDPTreeMatcher::PRESET_FAST);
    video->setUseTemporalPrediction(true);
    Mat ofSingle, ofVideo, changeOfSingle, changeOfVideo;
    RNG rng(1);
    for (int frame = 0; frame < 6; frame++)
    {
        Mat noisy[2], noise(left.size(), CV_32FC3), disparity16;
        for (int i = 0; i < 2; i++)
        {
            rng.fill(noise, RNG::NORMAL, 0, 8);
            add(i == 0 ? left : right, noise, noisy[i], noArray(), CV_8U);
        }
        for (const Ptr<HDPTreeMatcher>& matcher : { single, video })
        {
            Mat &disparity = matcher == single ? ofSingle : ofVideo,
                &change = matcher == single ? changeOfSingle : changeOfVideo;
            matcher->compute(noisy[0], noisy[1], disparity16);
            const Mat last = disparity.empty() ? Mat(left.size(), CV_32F, Scalar(0)) : disparity;
            disparity = toPixels(disparity16, pair.disparities.start);
            absdiff(disparity, last, change);
            change.convertTo(change, CV_8U, 64); // 4 pixels are white
            cvtColor(change, change, COLOR_GRAY2BGR);
        }
    }
    save("video.jpg", { colorPicture(ofSingle, range), changeOfSingle, colorPicture(ofVideo, range), changeOfVideo },
         INTER_AREA);

    std::vector<Mat> errors;
    for (const int preset : { HDPTreeMatcher::PRESET_PAPER, HDPTreeMatcher::PRESET_TREE, HDPTreeMatcher::PRESET_FAST })
        errors.push_back(withErrors(match(*create(preset)), pair, range));
    save("errors.jpg", errors, INTER_AREA);
    return 0;
}

int main(int argc, char** argv)
{
    return runProgram(argc, argv, KEYS,
                      "The pictures of the README and the tutorial: StereoSGBM beside PRESET_FAST, pair, maps of the "
                      "layers, disparity forest, confidence, errors.\n",
                      {}, 2, run);
}
