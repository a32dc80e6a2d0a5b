// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches videos frame by frame and with temporal prediction: errors, how much the disparities flicker, and time.

#include <cstdio>
#include <iostream>

#include "opencv2/core.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgproc.hpp"

#include "evaluation/bad_cameras.hpp"
#include "evaluation/command_line.hpp"
#include "evaluation/datasets.hpp"
#include "evaluation/methods.hpp"
#include "evaluation/progress.hpp"
#include "evaluation/scores.hpp"
#include "evaluation/tables.hpp"
#include "evaluation/tunables.hpp"
#include "evaluation/video_variants.hpp"

using namespace cv;
using namespace hdp_tools;

static const String KEYS =
    "{help h ?        |     | print this and exit }"
    "{@root           |     | folder of a video: left, right and, if the truth is known, disp_lidar; or of such "
    "folders }"
    "{methods         | fast,quality | names as of hdp_evaluate }"
    "{noise           |     | standard deviations of Gaussian noise in both images, in grey levels; by default 0,5 }"
    "{still           |     | in place of each video, its first frame so many times, with noise of its own each time }"
    "{pan             |     | in place of each video, each of its pairs as one that a camera pans over: RIGHT,DOWN "
    "pixels from frame to frame, in --still frames, or eight }"
    "{variants        |     | in place of that, variants of each video that may mislead; all, or a list of recorded, "
    "every2, every3, every4, reversed, random, three-times, exposure.7, exposure.5, fade, noise15, foreign, shake6, "
    "rows3 }"
    "{colors          |     | match colour images as they are, not in grey levels }"
    "{num-disparities |     | number of disparities; by default that of the dataset }"
    "{runs            | 1   | how often a video is matched; the shortest time of each frame counts }"
    "{threads         |     | number of threads; all processors if not given }";

static std::vector<double> readDeviations(const CommandLineParser& parser)
{
    std::vector<double> deviations;
    for (const String& item : splitList("noise", parser.has("noise") ? parser.get<String>("noise") : "0,5"))
    {
        char* end = nullptr;
        deviations.push_back(std::strtod(item.c_str(), &end));
        if (*end || !(deviations.back() >= 0 && deviations.back() <= 100))
            fail("--noise=" + item + ": not a number from 0 to 100");
    }
    return deviations;
}

static Point readStep(const String& text)
{
    int x = 0, y = 0, end = 0;
    if (std::sscanf(text.c_str(), "%d,%d%n", &x, &y, &end) != 2 || text[end] || std::abs(x) > 1000 ||
        std::abs(y) > 1000)
        fail("--pan=" + text + ": not RIGHT,DOWN in pixels, up to 1000");
    return Point(x, y);
}

//! A frame as it was taken
struct Frame
{
    Pair pair;   // the images in grey levels
    Mat isStill; // pixels of the left image, smoothed, that changed by less than 3 levels of 255 since the frame
                 // before; empty if that has another size or type
};

class Video
{
public:
    //! frames: which of the scenes to show, and what is done with them
    Video(const std::vector<Scene>& scenes, const std::vector<VariantFrame>& frames, bool isGrey, int numDisparities)
        : scenes_(scenes), frames_(frames), isGrey_(isGrey), numDisparities_(numDisparities)
    {
    }

    int size() const { return (int)frames_.size(); }

    Frame read(int index)
    {
        if (index == 0)
            rng_ = RNG(1); // the same frames in each run
        Scene scene = scenes_[frames_[index].index];
        if (!scene.truth.empty() && !utils::fs::exists(scene.truth))
            scene.truth.clear();
        Frame frame;
        Pair& pair = frame.pair;
        pair = readPair(scene);
        if (numDisparities_ > 0)
            pair.disparities = Range(0, numDisparities_);
        for (Mat* image : { &pair.left, &pair.right })
            if (isGrey_ && image->channels() == 3)
                cvtColor(*image, *image, COLOR_BGR2GRAY);
        changeFrame(frames_[index], rng_, pair);
        Mat smoothed, change;
        if (pair.left.channels() == 3)
            cvtColor(pair.left, smoothed, COLOR_BGR2GRAY);
        GaussianBlur(smoothed.empty() ? pair.left : smoothed, smoothed, Size(), 2);
        if (index > 0 && smoothed.size() == smoothed_.size() && smoothed.type() == smoothed_.type())
        {
            absdiff(smoothed, smoothed_, change);
            frame.isStill = change < (smoothed.depth() == CV_16U ? 3 * 257 : 3);
        }
        smoothed_ = smoothed;
        return frame;
    }

private:
    const std::vector<Scene>& scenes_;
    const std::vector<VariantFrame> frames_;
    const bool isGrey_;
    const int numDisparities_;
    RNG rng_;      // of the variant
    Mat smoothed_; // of the frame before
};

//! A method on the frames of a video
class Stream
{
public:
    Stream(const Method& method, bool isTemporal) : method_(method), isTemporal_(isTemporal) {}

    //! Has nothing to do if the method knows no temporal prediction.
    bool isIdle() const { return isTemporal_ && !method_.isHdp; }

    //! A frame among all that the stream gets
    struct Place
    {
        int index;            // they come one after the other, or again
        bool isFirst;         // of its video
        bool counts, isTimed; // whether its errors count, and its time
    };

    void match(const Mat& left, const Mat& right, const Frame& frame, const Place& place)
    {
        if (isIdle())
            return;
        if (place.isFirst)
        {
            matcher_ = method_.create(frame.pair.disparities);
            if (method_.isHdp)
                matcher_.dynamicCast<HDPTreeMatcher>()->setUseTemporalPrediction(isTemporal_);
        }
        double seconds;
        std::array<Mat, 2> images = { { left, right } };
        for (Mat& image : images)
            if (!method_.isHdp && image.type() == CV_8UC1)
                cvtColor(image, image, COLOR_GRAY2BGR);
        const Mat disparity = matchDensely(method_, *matcher_, images[0], images[1], &seconds);
        CV_Assert(place.index <= (int)times_.size());
        if ((int)times_.size() == place.index)
        {
            times_.push_back({ seconds, place.isTimed });
            if (place.counts)
                addErrors(disparity, frame);
        }
        times_[place.index].seconds = std::min(times_[place.index].seconds, seconds);
        disparity_ = disparity;
    }

    double d1() const { return meanScore(scores_).d1; }
    //! Area under the sparsification curve of the confidence, over the least that there could be
    double sparsification() const
    {
        const Score mean = meanScore(scores_);
        return mean.sparsification / mean.leastSparsification;
    }
    //! The worst of the frames beside another stream's, in points of D1
    double mostAbove(const Stream& other) const
    {
        double most = NO_SCORE;
        for (size_t i = 0; i < scores_.size() && i < other.scores_.size(); ++i)
            if (!(scores_[i].d1 - other.scores_[i].d1 <= most))
                most = scores_[i].d1 - other.scores_[i].d1;
        return most;
    }
    double flicker() const { return pixels_ > 0 ? change_ / pixels_ : NO_SCORE; }
    double changed() const { return pixels_ > 0 ? 100. * changed_ / pixels_ : NO_SCORE; }
    double milliseconds() const
    {
        std::vector<double> timed;
        for (const Time& time : times_)
            if (time.counts)
                timed.push_back(time.seconds);
        return 1e3 * meanOf(timed);
    }

private:
    void addErrors(const Mat& disparity, const Frame& frame)
    {
        if (frame.pair.protocol != Pair::NO_TRUTH)
        {
            Score score = scoreMap(disparity, frame.pair);
            if (method_.isHdp)
            {
                Mat confidence;
                matcher_.dynamicCast<HDPTreeMatcher>()->getConfidence(confidence);
                findSparsification(wrongPixels(disparity, frame.pair), frame.pair.judged, confidence, score);
            }
            scores_.push_back(score);
        }
        if (disparity_.empty() || frame.isStill.empty())
            return;
        const Mat isKnown = frame.isStill & knownPixels(disparity) & knownPixels(disparity_);
        Mat change;
        absdiff(disparity, disparity_, change);
        pixels_ += countNonZero(isKnown);
        changed_ += countNonZero((change > 1) & isKnown);
        change.setTo(0, ~isKnown);
        change_ += sum(change)[0];
    }

    struct Time
    {
        double seconds;
        bool counts;
    };

    Method method_;
    bool isTemporal_;
    Ptr<StereoMatcher> matcher_;
    Mat disparity_;                  // of the last frame
    std::vector<Time> times_;        // by frame
    std::vector<Score> scores_;      // of the frames that count
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
    table.header = { "method",       "noise",    "D1",   "temporal", "flicker px", "temporal",
                     "above 1 px %", "temporal", "area", "temporal", "ms",         "temporal" };
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
        table.addNumber(single.sparsification());
        table.addNumber(temporal.sparsification());
        table.addNumber(single.milliseconds(), "%.1f");
        table.addNumber(temporal.milliseconds(), "%.1f");
    }
    return table;
}

static Table toTable(const String& title, const std::vector<VideoVariant>& variants, const std::vector<Method>& methods,
                     const std::vector<Streams>& streams)
{
    Table table;
    table.title = title;
    table.header = { "variant",    "method",   "D1",    "temporal", "ratio",   "worst frame",
                     "flicker px", "temporal", "ratio", "ms",       "temporal" };
    for (size_t i = 0; i < streams.size(); ++i)
    {
        const Stream &single = streams[i][0], &temporal = streams[i][1];
        table.addRow(variants[i / methods.size()].name);
        table.addText(methods[i % methods.size()].name);
        table.addNumber(single.d1());
        table.addNumber(temporal.d1());
        table.addNumber(temporal.d1() / single.d1(), "%.3f");
        table.addNumber(temporal.mostAbove(single), "%+.2f");
        table.addNumber(single.flicker());
        table.addNumber(temporal.flicker());
        table.addNumber(temporal.flicker() / single.flicker(), "%.3f");
        table.addNumber(single.milliseconds(), "%.1f");
        table.addNumber(temporal.milliseconds(), "%.1f");
    }
    return table;
}

//! Matches a video, all streams in turns: those of each noise, and of it those of each method. Frames from firstCounted
//! on count. before: frames of other videos that the streams got
static void matchVideo(Video video, int before, int runs, const std::vector<double>& noise, int firstCounted,
                       Streams* streams, size_t methods, Progress& progress)
{
    const int frames = video.size();
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
                        streams[k * methods + m][(i + turn) % 2].match(
                            left, right, frame, { before + i, i == 0, i >= firstCounted, i >= frames / 2 });
            }
            progress.step(format("frame %d", i));
        }
    }
}

//! What to do with each video
struct Task
{
    std::vector<Method> methods;
    std::vector<double> noise;
    int numDisparities, stillFrames, runs;
    bool hasVariants, isGrey, isPanned;
    String variants;
    Point step; // of a camera that pans
};

//! Streams of each noise, and of it of each method
static std::vector<Streams> makeStreams(const Task& task)
{
    std::vector<Streams> streams;
    for (size_t k = 0; k < task.noise.size(); ++k)
        for (const Method& method : task.methods)
            streams.push_back(Streams{ { Stream(method, false), Stream(method, true) } });
    return streams;
}

//! The table of pairs that a camera pans over
static Table evaluatePans(const Task& task, const std::vector<Scene>& scenes)
{
    const int frames = task.stillFrames > 0 ? task.stillFrames : 8, firstCounted = frames / 2;
    std::vector<Streams> streams = makeStreams(task);
    Progress progress(scenes.size() * frames * task.runs);
    for (size_t i = 0; i < scenes.size(); ++i)
    {
        const Size size = readPicture(scenes[i].left).size();
        const Video video(scenes, panOver((int)i, size, task.step, frames), task.isGrey, task.numDisparities);
        matchVideo(video, (int)i * frames, task.runs, task.noise, firstCounted, streams.data(), task.methods.size(),
                   progress);
    }
    progress.finish();
    return toTable(format("%s: pans over %d pairs, the last %d of %d frames", scenes[0].set.c_str(), (int)scenes.size(),
                          frames - firstCounted, frames),
                   task.noise, task.methods, streams);
}

//! The table of a video
static Table evaluate(const Task& task, const std::vector<Scene>& scenes)
{
    const int recorded = (int)scenes.size();
    const String& name = scenes[0].set;
    const size_t methods = task.methods.size();
    std::vector<VideoVariant> variants = selectVariants(task.hasVariants ? task.variants : "recorded", recorded);
    if (task.stillFrames > 0)
        variants[0].frames.assign(task.stillFrames, VariantFrame());
    if (variants[0].frames.size() < 2)
        fail("one frame is no video");
    size_t steps = 0;
    std::vector<Streams> streams;
    for (const VideoVariant& variant : variants)
    {
        steps += variant.frames.size() * task.runs;
        for (const Streams& own : makeStreams(task))
            streams.push_back(own);
    }
    Progress progress(steps);
    const int frames = (int)variants[0].frames.size(), firstCounted = task.hasVariants ? 0 : frames / 2;
    for (size_t v = 0; v < variants.size(); ++v)
        matchVideo(Video(scenes, variants[v].frames, task.isGrey, task.numDisparities), 0, task.runs, task.noise,
                   firstCounted, &streams[v * task.noise.size() * methods], methods, progress);
    progress.finish();
    if (task.hasVariants)
        return toTable(format("%s: variants of %d frames", name.c_str(), recorded), variants, task.methods, streams);
    return toTable(format("%s: the last %d of %d frames", name.c_str(), frames - firstCounted, frames), task.noise,
                   task.methods, streams);
}

static Task readTask(const CommandLineParser& parser)
{
    Task task;
    task.methods = selectMethods("methods", parser.get<String>("methods"));
    task.hasVariants = parser.has("variants");
    const String variants = task.hasVariants ? parser.get<String>("variants") : String();
    task.variants = variants == "true" ? String() : variants; // without a value
    task.isPanned = parser.has("pan");
    if (task.hasVariants && (parser.has("noise") || parser.has("still") || task.isPanned))
        fail("--variants does not go with --noise, --still or --pan");
    if (task.isPanned)
        task.step = readStep(parser.get<String>("pan"));
    selectVariants(task.variants, 1);
    task.noise = task.hasVariants ? std::vector<double>(1, 0.) : readDeviations(parser);
    task.numDisparities = parser.has("num-disparities") ? getInteger(parser, "num-disparities", 1, 2048) : 0;
    task.stillFrames = parser.has("still") ? getInteger(parser, "still", 2, 10000) : 0;
    task.runs = getInteger(parser, "runs", 1, 1000);
    task.isGrey = !parser.has("colors");
    return task;
}

static int run(const CommandLineParser& parser)
{
    if (useTunables(parser))
        return 0;
    if (!parser.has("@root"))
        fail("a folder is needed, see --help");
    setThreads(parser);
    const Task task = readTask(parser);
    std::vector<std::vector<Scene>> videos;
    for (const Scene& scene : findScenes(parser.get<String>("@root")))
    {
        if (videos.empty() || videos.back()[0].set != scene.set)
            videos.push_back(std::vector<Scene>());
        videos.back().push_back(scene);
    }
    catchInterrupts();
    size_t skipped = 0;
    for (const std::vector<Scene>& scenes : videos)
        try
        {
            const Table table = task.isPanned ? evaluatePans(task, scenes) : evaluate(task, scenes);
            if (isInterrupted())
                break;
            std::cout << toMarkdown(table) << std::endl;
        }
        catch (const std::exception& error)
        {
            std::cerr << "skipped " << scenes[0].set << ": " << messageOf(error) << std::endl;
            ++skipped;
        }
    return endOfRun(skipped, videos.size(), "videos");
}

int main(int argc, char** argv)
{
    return runProgram(
        argc, argv, KEYS + TUNABLE_KEYS,
        "What temporal prediction is worth on videos of rectified stereo pairs: errors (D1), flicker and time.\n"
        "Area is that under the sparsification curve of the confidence, over the least that there could be.\n"
        "Flicker is the mean change of the disparity from frame to frame where the left image, smoothed, changes by\n"
        "less than 3 levels of 255. The last half of the frames counts. Of variants, the errors of all frames do; the\n"
        "worst frame is the one with the largest difference of D1, in points.\n"
        "Exit status: 0 if all is well, 2 if a video was skipped, 130 if interrupted, 1 on other errors.\n",
        { "variants=", "colors" }, 1, run);
}
