// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Makes the pictures of the README and the tutorial, from a rectified pair with truth: what the stages of HDPTreeMatcher
// give, and StereoSGBM beside them.

#include <functional>
#include <iostream>
#include <limits>

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

typedef std::function<void(const String& name, const std::vector<Mat>& pictures, int interpolation)> Save;

static Mat match(HDPTreeMatcher& matcher, const Mat& left, const Mat& right)
{
    Mat disparity;
    matcher.compute(left, right, disparity);
    return toPixels(disparity, matcher.getMinDisparity());
}

//! Levels from 0 to a value that is white
static Mat greyPicture(const Mat& values, double white)
{
    Mat picture;
    values.convertTo(picture, CV_8U, 255 / white);
    cvtColor(picture, picture, COLOR_GRAY2BGR);
    return picture;
}

//! A bonnet before both cameras, which reflects something else in each: with it, without and with masks
static void saveMasked(const Pair& pair, const Vec2f& range, const Save& save)
{
    Mat images[] = { pair.left.clone(), pair.right.clone() }, mask(pair.left.size(), CV_8U, Scalar(255));
    toColors(images[0], images[1]);
    const Point centre(mask.cols / 2, mask.rows);
    ellipse(mask, centre, Size(mask.cols * 9 / 20, mask.rows / 4), 0, 0, 360, Scalar(0), FILLED, LINE_8);
    RNG rng(1);
    for (Mat& image : images)
    {
        Mat reflections(9, 13, CV_8UC3);
        rng.fill(reflections, RNG::UNIFORM, 20, 130);
        resize(reflections, reflections, image.size(), 0, 0, INTER_CUBIC);
        reflections.copyTo(image, mask == 0);
    }
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(pair.disparities.start, pair.disparities.size());
    const Mat without = match(*matcher, images[0], images[1]);
    matcher->setMasks(mask, mask);
    save("masked.jpg",
         { images[0], colorPicture(without, range), colorPicture(match(*matcher, images[0], images[1]), range) },
         INTER_AREA);
}

//! Points of the truth, as of a lidar, and what they mend
static void savePrior(const Pair& pair, const Vec2f& range, const Save& save)
{
    const int count = 2000;
    Mat points(pair.left.size(), CV_32F, Scalar(std::numeric_limits<float>::quiet_NaN())), picture, other = pair.right;
    picture = pair.left.clone();
    toColors(picture, other);
    picture *= 0.5;
    const Mat colors = colorPicture(pair.truth, range);
    RNG rng(1);
    for (int i = 0; i < count; i++)
    {
        const Point place(rng.uniform(0, points.cols), rng.uniform(0, points.rows));
        if (pair.judged.at<uchar>(place) == 0)
            continue;
        points.at<float>(place) = pair.truth.at<float>(place);
        circle(picture, place, std::max(points.cols / 300, 1), Scalar(colors.at<Vec3b>(place)), FILLED);
    }
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(pair.disparities.start, pair.disparities.size());
    const Mat without = withErrors(match(*matcher, pair.left, pair.right), pair, range);
    matcher->setPriorDisparity(points, 0.5);
    save("prior.jpg", { picture, without, withErrors(match(*matcher, pair.left, pair.right), pair, range) },
         INTER_AREA);
}

//! What getDisparitySigma() says, and the errors
static void saveSigma(const Pair& pair, const Vec2f& range, const Save& save)
{
    const double white = 3; // pixels
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(pair.disparities.start, pair.disparities.size());
    const Mat disparity = match(*matcher, pair.left, pair.right);
    Mat sigma, errors = abs(disparity - pair.truth);
    matcher->getDisparitySigma(sigma);
    errors.setTo(0, ~pair.judged);
    save("sigma.jpg", { colorPicture(disparity, range), greyPicture(sigma, white), greyPicture(errors, white) },
         INTER_AREA);
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
    const auto match = [&](HDPTreeMatcher& matcher) { return ::match(matcher, pair.left, pair.right); };
    const Save save = [&](const String& name, const std::vector<Mat>& pictures, int interpolation) {
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
        match(*matcher);
        const int layers = (int)matcher->getFindings().searchRatios.size();
        std::vector<Mat> maps;
        for (int layer = std::min(layers, 3) - 1; layer >= 0; layer--)
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

    saveMasked(pair, range, save);
    savePrior(pair, range, save);
    saveSigma(pair, range, save);
    return 0;
}

int main(int argc, char** argv)
{
    return runProgram(argc, argv, KEYS,
                      "The pictures of the README and the tutorial: StereoSGBM beside PRESET_FAST, pair, maps of the "
                      "layers, disparity forest, confidence, errors; masks, a prior and sigma. --truth is needed.\n",
                      {}, 2, run);
}
