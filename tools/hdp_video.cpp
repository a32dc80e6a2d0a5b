// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches videos frame by frame and with temporal prediction: errors, how much the disparities flicker, and time.

#include <iostream>

#include "opencv2/core.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgproc.hpp"

#include "evaluation/command_line.hpp"
#include "evaluation/datasets.hpp"
#include "evaluation/methods.hpp"
#include "evaluation/progress.hpp"
#include "evaluation/scores.hpp"
#include "evaluation/tables.hpp"

using namespace cv;
using namespace hdp_tools;

static const char* const KEYS =
    "{help h ?        |     | print this and exit }"
    "{@root           |     | folder of a video: left, right and, if the truth is known, disp_lidar; or of such "
    "folders }"
    "{methods         | fast,quality | names as of hdp_evaluate }"
    "{noise           | 0,5 | standard deviations of Gaussian noise in both images, in grey levels }"
    "{still           |     | in place of each video, its first frame so many times, with noise of its own each time }"
    "{num-disparities |     | number of disparities; by default that of the dataset }"
    "{runs            | 1   | how often a video is matched; the shortest time of each frame counts }"
    "{threads         |     | number of threads; all processors if not given }";

static std::vector<double> readDeviations(const CommandLineParser& parser)
{
    std::vector<double> deviations;
    for (const String& item : splitList(parser.get<String>("noise")))
    {
        char* end = nullptr;
        deviations.push_back(std::strtod(item.c_str(), &end));
        if (*end || !(deviations.back() >= 0 && deviations.back() <= 100))
            fail("--noise=" + item + ": not a number from 0 to 100");
    }
    if (deviations.empty())
        fail("--noise names no standard deviation");
    return deviations;
}

//! A frame as it was taken
struct Frame
{
    Pair pair;   // the images in grey levels
    Mat isStill; // pixels of the left image, smoothed, that changed by less than 3 levels of 255 since the frame before
};

class Video
{
public:
    //! stillFrames: how often to show the first frame; 0: the video as it is
    Video(const std::vector<Scene>& scenes, int stillFrames, int numDisparities)
        : scenes_(scenes), stillFrames_(stillFrames), numDisparities_(numDisparities)
    {
    }

    int size() const { return stillFrames_ > 0 ? stillFrames_ : (int)scenes_.size(); }

    Frame read(int index)
    {
        Scene scene = scenes_[stillFrames_ > 0 ? 0 : index];
        if (!scene.truth.empty() && !utils::fs::exists(scene.truth))
            scene.truth.clear();
        Frame frame;
        Pair& pair = frame.pair;
        pair = readPair(scene);
        if (numDisparities_ > 0)
            pair.disparities = Range(0, numDisparities_);
        for (Mat* image : { &pair.left, &pair.right })
            if (image->channels() == 3)
                cvtColor(*image, *image, COLOR_BGR2GRAY);
        Mat smoothed, change;
        GaussianBlur(pair.left, smoothed, Size(), 2);
        if (index > 0)
        {
            if (smoothed.size() != smoothed_.size() || smoothed.type() != smoothed_.type())
                fail("'" + scene.left + "' has another size or type than the frame before");
            absdiff(smoothed, smoothed_, change);
            frame.isStill = change < (smoothed.depth() == CV_16U ? 3 * 257 : 3);
        }
        smoothed_ = smoothed;
        return frame;
    }

private:
    const std::vector<Scene>& scenes_;
    const int stillFrames_, numDisparities_;
    Mat smoothed_; // of the frame before
};

static Mat addNoise(const Mat& image, double deviation, RNG& rng)
{
    if (deviation == 0)
        return image;
    Mat noise(image.size(), CV_32F), noisy;
    rng.fill(noise, RNG::NORMAL, 0, deviation);
    add(image, noise, noisy, noArray(), image.depth());
    return noisy;
}

//! A method on the frames of a video
class Stream
{
public:
    Stream(const Method& method, bool isTemporal) : method_(method), isTemporal_(isTemporal) {}

    //! Has nothing to do if the method knows no temporal prediction.
    bool isIdle() const { return isTemporal_ && !method_.isHdp; }

    void match(const Mat& left, const Mat& right, const Frame& frame, int index, bool counts)
    {
        if (isIdle())
            return;
        if (!matcher_)
            matcher_ = method_.create(frame.pair.disparities);
        if (method_.isHdp && index == 0)
        {
            matcher_->clear();
            matcher_.dynamicCast<HDPTreeMatcher>()->setUseTemporalPrediction(isTemporal_);
        }
        double seconds;
        std::array<Mat, 2> images = { { left, right } };
        for (Mat& image : images)
            if (!method_.isHdp && image.depth() == CV_8U)
                cvtColor(image, image, COLOR_GRAY2BGR);
        const Mat disparity = matchDensely(method_, *matcher_, images[0], images[1], &seconds);
        if ((int)seconds_.size() <= index)
        {
            seconds_.push_back(seconds);
            if (counts)
                addErrors(disparity, frame);
        }
        seconds_[index] = std::min(seconds_[index], seconds);
        disparity_ = disparity;
    }

    double d1() const { return meanOf(d1_); }
    double flicker() const { return pixels_ > 0 ? change_ / pixels_ : NO_SCORE; }
    double changed() const { return pixels_ > 0 ? 100. * changed_ / pixels_ : NO_SCORE; }
    double milliseconds() const
    {
        return 1e3 * meanOf(std::vector<double>(seconds_.begin() + seconds_.size() / 2, seconds_.end()));
    }

private:
    void addErrors(const Mat& disparity, const Frame& frame)
    {
        if (frame.pair.protocol != Pair::NO_TRUTH)
            d1_.push_back(scoreMap(disparity, frame.pair).d1);
        if (disparity_.empty())
            return;
        const Mat isKnown = frame.isStill & knownPixels(disparity) & knownPixels(disparity_);
        Mat change;
        absdiff(disparity, disparity_, change);
        pixels_ += countNonZero(isKnown);
        changed_ += countNonZero((change > 1) & isKnown);
        change.setTo(0, ~isKnown);
        change_ += sum(change)[0];
    }

    Method method_;
    bool isTemporal_;
    Ptr<StereoMatcher> matcher_;
    Mat disparity_;                  // of the last frame
    std::vector<double> seconds_;    // by frame
    std::vector<double> d1_;         // of the frames that count
    double change_ = 0;              // of the disparities from frame to frame, where the image stands still
    int64 pixels_ = 0, changed_ = 0; // how many these are, and those with a change above 1
};

//! Without and with temporal prediction
typedef std::array<Stream, 2> Streams;

static Table toTable(const String& title, const std::vector<double>& noise, const std::vector<Method>& methods,
                     const std::vector<Streams>& streams)
{
    Table table;
    table.title = title;
    table.header = { "method",   "noise",        "D1",       "temporal", "flicker px",
                     "temporal", "above 1 px %", "temporal", "ms",       "temporal" };
    for (size_t i = 0; i < streams.size(); ++i)
    {
        const Stream &single = streams[i][0], &temporal = streams[i][1];
        table.addRow(methods[i % methods.size()].name);
        table.addNumber(noise[i / methods.size()], "%g");
        table.addNumber(single.d1());
        table.addNumber(temporal.d1());
        table.addNumber(single.flicker());
        table.addNumber(temporal.flicker());
        table.addNumber(single.changed(), "%.1f");
        table.addNumber(temporal.changed(), "%.1f");
        table.addNumber(single.milliseconds(), "%.1f");
        table.addNumber(temporal.milliseconds(), "%.1f");
    }
    return table;
}

//! Matches a video, all streams in turns.
static void matchVideo(Video& video, int runs, const std::vector<double>& noise, std::vector<Streams>& streams,
                       Progress& progress)
{
    const int frames = video.size();
    const size_t methods = streams.size() / noise.size();
    for (int run = 0; run < runs; ++run)
    {
        RNG rng(1);
        for (int i = 0; i < frames && !isInterrupted(); ++i)
        {
            const Frame frame = video.read(i);
            for (size_t k = 0; k < noise.size(); ++k)
            {
                const Mat left = addNoise(frame.pair.left, noise[k], rng),
                          right = addNoise(frame.pair.right, noise[k], rng);
                for (size_t m = 0; m < methods; ++m)
                    for (int turn = 0; turn < 2; ++turn)
                        streams[k * methods + m][(i + turn) % 2].match(left, right, frame, i, i >= frames / 2);
            }
            progress.step(format("frame %d", i));
        }
    }
}

static int run(const CommandLineParser& parser)
{
    if (!parser.has("@root"))
        fail("a folder is needed, see --help");
    setThreads(parser);
    const std::vector<Method> methods = selectMethods("methods", parser.get<String>("methods"));
    const std::vector<double> noise = readDeviations(parser);
    const int numDisparities = parser.has("num-disparities") ? getInteger(parser, "num-disparities", 1, 2048) : 0;
    const int stillFrames = parser.has("still") ? getInteger(parser, "still", 2, 10000) : 0;
    const int runs = getInteger(parser, "runs", 1, 1000);
    std::vector<std::vector<Scene>> videos;
    for (const Scene& scene : findScenes(parser.get<String>("@root")))
    {
        if (videos.empty() || videos.back()[0].set != scene.set)
            videos.push_back(std::vector<Scene>());
        videos.back().push_back(scene);
    }
    catchInterrupts();
    int skipped = 0;
    for (const std::vector<Scene>& scenes : videos)
    {
        const String& name = scenes[0].set;
        Video video(scenes, stillFrames, numDisparities);
        const int frames = video.size();
        Progress progress(frames * runs);
        std::vector<Streams> streams;
        for (size_t k = 0; k < noise.size(); ++k)
            for (const Method& method : methods)
                streams.push_back(Streams{ { Stream(method, false), Stream(method, true) } });
        try
        {
            if (frames < 2)
                fail("one frame is no video");
            matchVideo(video, runs, noise, streams, progress);
        }
        catch (const std::exception& error)
        {
            progress.message("skipped " + name + ": " + error.what());
            ++skipped;
            continue;
        }
        progress.finish();
        if (isInterrupted())
            return 130;
        const String title = format("%s: the last %d of %d frames", name.c_str(), frames - frames / 2, frames);
        std::cout << toMarkdown(toTable(title, noise, methods, streams)) << std::endl;
    }
    return skipped > 0 ? 2 : 0;
}

int main(int argc, char** argv)
{
    return runProgram(
        argc, argv, KEYS,
        "What temporal prediction is worth on videos of rectified stereo pairs: errors (D1), flicker and time.\n"
        "Flicker is the mean change of the disparity from frame to frame where the left image, smoothed, changes by\n"
        "less than 3 levels of 255. The last half of the frames counts.\n"
        "Exit status: 0 if all is well, 2 if a video was skipped, 130 if interrupted, 1 on other errors.\n",
        {}, 1, run);
}
