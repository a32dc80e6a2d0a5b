// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches a live source with cv::stereo::HDPTreeMatcher: two cameras or files, or one that has both images side by side.
// Shows the left image beside its disparities with the frames a second, or, without a display, prints them; can write
// what it shows to a video or to pictures.

#include <cstdlib>
#include <iostream>

#include "opencv2/opencv_modules.hpp"
#include "opencv2/videoio.hpp"
#ifdef HAVE_OPENCV_HIGHGUI
#include "opencv2/highgui.hpp"
#endif
#include "opencv2/hdpstereo.hpp"

#include "hdp_samples_common.hpp"

using namespace cv;
using namespace hdp_samples;
using cv::stereo::HDPTreeMatcher;

static const char* const KEYS =
    "{help h ?        |      | print this and exit }"
    "{@left           |      | left images: a video, pictures by number (left%02d.jpg), an address, or a camera's "
    "number }"
    "{@right          |      | right images; if not given, the left source has both side by side }"
    "{right-first     |      | side by side: the right image is the left half }"
    "{intrinsics i    |      | calibration as stereo_calib.cpp of OpenCV's samples writes it, M1 D1 M2 D2; without it "
    "the "
    "images are taken as rectified }"
    "{extrinsics e    |      | its other file, R and T }"
    "{scale           | 1    | size of the images to match, relative to those of the source: 0.05 to 1 }"
    "{preset          | fast | set of parameters: ultrafast, fast, quality, tree, or paper }"
    "{min-disparity   | 0    | smallest disparity in pixels, after scaling }"
    "{num-disparities |      | number of disparities; by default width / 5, rounded up to a multiple of 16 }"
    "{frames          |      | stop after this many; by default at the end of the source, or at Esc or q }"
    "{output          |      | what is shown: a video (FILE.avi, Motion JPEG) or pictures (FILE%04d.png) }"
    "{no-gui          |      | no window }"
    "{threads         |      | number of threads; all processors if not given }";

static const std::vector<String> FLAGS = { "help", "h", "?", "right-first", "no-gui" };

//! Where the pairs come from
class StereoSource
{
public:
    explicit StereoSource(const CommandLineParser& parser)
        : sideBySide_(!parser.has("@right")), rightFirst_(parser.has("right-first"))
    {
        if (!parser.has("@left"))
            fail("a source is needed, see --help");
        if (rightFirst_ && !sideBySide_)
            fail("--right-first is for one source that has both images side by side");
        open(parser.get<String>("@left"), left_);
        if (!sideBySide_)
            open(parser.get<String>("@right"), right_);
    }

    //! False at the end.
    bool read(Mat& left, Mat& right)
    {
        // Both are grabbed before one is decoded, so that two cameras see the same moment.
        if (!left_.grab() || (!sideBySide_ && !right_.grab()))
            return false;
        if (sideBySide_)
        {
            if (!left_.retrieve(frame_) || frame_.cols < 2)
                return false;
            const int half = frame_.cols / 2;
            left = frame_.colRange(0, half);
            right = frame_.colRange(half, 2 * half);
            if (rightFirst_)
                swap(left, right);
        }
        else if (!left_.retrieve(left) || !right_.retrieve(right))
            return false;
        if (left.size() != right.size() || left.type() != right.type())
            fail(format("the images differ: %d x %d and %d x %d", left.cols, left.rows, right.cols, right.rows));
        return true;
    }

    double fps() const
    {
        const double fps = left_.get(CAP_PROP_FPS);
        return fps >= 1 && fps <= 1000 ? fps : 25; // cameras and pictures may not know
    }

private:
    static void open(const String& name, VideoCapture& capture)
    {
        const bool isNumber = !name.empty() && name.size() < 4 && name.find_first_not_of("0123456789") == String::npos;
        if (isNumber ? !capture.open(std::atoi(name.c_str())) : !capture.open(name))
            fail((isNumber ? "cannot open the camera " : "cannot open '") + name + (isNumber ? "" : "'"));
    }

    bool sideBySide_, rightFirst_;
    VideoCapture left_, right_;
    Mat frame_;
};

static Mat readMatrix(const FileStorage& fs, const String& path, const String& name, int rows, int cols)
{
    Mat matrix;
    fs[name] >> matrix;
    const bool isVector = rows == 0; // of any length
    if (matrix.empty() || matrix.channels() != 1 || (!isVector && matrix.size() != Size(cols, rows)))
        fail("'" + path + "' has no " + (isVector ? "vector " : format("%d x %d matrix ", rows, cols)) + name);
    matrix.convertTo(matrix, CV_64F);
    return matrix;
}

static FileStorage openCalibration(const String& path)
{
    FileStorage fs;
    try
    {
        fs.open(path, FileStorage::READ);
    }
    catch (const cv::Exception&)
    {
    }
    if (!fs.isOpened())
        fail("cannot read the calibration '" + path + "'");
    return fs;
}

//! Brings both images onto the same rows, by the maps of a calibration; without one it leaves them alone.
class Rectifier
{
public:
    explicit Rectifier(const CommandLineParser& parser)
    {
        if (parser.has("intrinsics") != parser.has("extrinsics"))
            fail("--intrinsics and --extrinsics need each other");
        if (!parser.has("intrinsics"))
            return;
        const String inner = parser.get<String>("intrinsics"), outer = parser.get<String>("extrinsics");
        const FileStorage in = openCalibration(inner), out = openCalibration(outer);
        for (int i = 0; i < 2; ++i)
        {
            camera_[i] = readMatrix(in, inner, i == 0 ? "M1" : "M2", 3, 3);
            distortion_[i] = readMatrix(in, inner, i == 0 ? "D1" : "D2", 0, 0);
        }
        R_ = readMatrix(out, outer, "R", 3, 3);
        T_ = readMatrix(out, outer, "T", 3, 1);
    }

    void apply(Mat& left, Mat& right)
    {
        if (R_.empty())
            return;
        if (left.size() != size_)
            makeMaps(left.size());
        remap(left, rectified_[0], maps_[0][0], maps_[0][1], INTER_LINEAR);
        remap(right, rectified_[1], maps_[1][0], maps_[1][1], INTER_LINEAR);
        left = rectified_[0];
        right = rectified_[1];
    }

private:
    void makeMaps(Size size)
    {
        Mat R[2], P[2], Q;
        stereoRectify(camera_[0], distortion_[0], camera_[1], distortion_[1], size, R_, T_, R[0], R[1], P[0], P[1], Q);
        if (std::abs(P[1].at<double>(1, 3)) > std::abs(P[1].at<double>(0, 3)))
            fail("the calibration is of a camera above the other; this sample has no use for it");
        for (int i = 0; i < 2; ++i)
            initUndistortRectifyMap(camera_[i], distortion_[i], R[i], P[i], size, CV_16SC2, maps_[i][0], maps_[i][1]);
        size_ = size;
    }

    Size size_;
    Mat camera_[2], distortion_[2], R_, T_;
    Mat maps_[2][2], rectified_[2];
};

//! Where the pictures go: a window, a file, or neither
class Viewer
{
public:
    explicit Viewer(const CommandLineParser& parser)
        : path_(parser.get<String>("output")), window_(!parser.has("no-gui") && haveDisplay())
    {
        if (!path_.empty() && !isSequence() && !hasExtension(path_, ".avi"))
            fail("--output=" + path_ +
                 ": neither a .avi file nor the name of pictures with their number (FILE%04d.png)");
        if (!window_ && !parser.has("no-gui"))
            std::cout << "no display: printing only" << std::endl;
    }

    //! Returns false if the user wants to stop.
    bool show(const Mat& picture, double fps)
    {
        if (!path_.empty())
        {
            if (!writer_.isOpened() &&
                !(isSequence() ? writer_.open(path_, CAP_IMAGES, 0, 0, picture.size())
                               : writer_.open(path_, VideoWriter::fourcc('M', 'J', 'P', 'G'), fps, picture.size())))
                fail("cannot write '" + path_ + "'");
            writer_.write(picture);
        }
#ifdef HAVE_OPENCV_HIGHGUI
        try
        {
            if (window_)
            {
                imshow("hdp_live", picture);
                const int key = waitKey(1) & 255;
                return key != 27 && key != 'q';
            }
        }
        catch (const cv::Exception&) // OpenCV was built without windows
        {
            window_ = false;
            std::cout << "no windows: printing only" << std::endl;
        }
#endif
        return true;
    }

private:
    bool isSequence() const { return path_.find('%') != String::npos; }

    //! A window without a display may end the program, not just throw.
    static bool haveDisplay()
    {
#if !defined HAVE_OPENCV_HIGHGUI
        return false;
#elif defined __unix__ && !defined __APPLE__
        for (const char* name : { "DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM" })
        {
            const char* const value = std::getenv(name);
            if (value && *value)
                return true;
        }
        return false;
#else
        return true;
#endif
    }

    const String path_;
    bool window_;
    VideoWriter writer_;
};

static Mat drawPicture(const Mat& left, const Mat& disparity16, Range disparities, const String& text)
{
    Mat picture;
    const Vec2f range((float)disparities.start, (float)std::max(disparities.end - 1, disparities.start + 1));
    hconcat(left, colorPicture(toPixels(disparity16, disparities.start), range), picture);
    const double size = std::max(picture.cols / 1280., 0.4);
    const Point origin(cvRound(12 * size), cvRound(30 * size));
    putText(picture, text, origin, FONT_HERSHEY_SIMPLEX, size, Scalar::all(0), cvRound(4 * size) + 1, LINE_AA);
    putText(picture, text, origin, FONT_HERSHEY_SIMPLEX, size, Scalar::all(255), cvRound(size), LINE_AA);
    return picture;
}

//! Frames a second, over about a second; and the time of matching alone
class Speed
{
public:
    Speed() : frames_(0), matched_(0), all_(0), allMatched_(0)
    {
        total_.start();
        second_.start();
    }

    void add(double matchMilliseconds)
    {
        ++frames_;
        ++all_;
        matched_ += matchMilliseconds;
        allMatched_ += matchMilliseconds;
        second_.stop();
        if (second_.getTimeSec() >= 1 || text_.empty())
        {
            text_ = format("%.1f frames/s, matching %.1f ms", frames_ / second_.getTimeSec(), matched_ / frames_);
            if (second_.getTimeSec() >= 1)
                std::cout << format("frame %-6d", all_) << text_ << std::endl;
            second_.reset();
            frames_ = 0;
            matched_ = 0;
        }
        second_.start();
    }

    const String& text() const { return text_; }

    void printTotal()
    {
        total_.stop();
        std::cout << format("%d frames, %.1f frames/s, matching %.1f ms a frame", all_, all_ / total_.getTimeSec(),
                            allMatched_ / std::max(all_, 1))
                  << std::endl;
    }

private:
    TickMeter total_, second_;
    int frames_;
    double matched_;
    int all_;
    double allMatched_;
    String text_;
};

static void run(const CommandLineParser& parser)
{
    if (parser.has("threads"))
        setNumThreads(getInteger(parser, "threads", 1, 1024));
    const double scale = getNumber(parser, "scale", 0.05, 1);
    const int maxFrames = parser.has("frames") ? getInteger(parser, "frames", 1, INT_MAX) : INT_MAX;
    const int preset = getPreset(parser, "preset");
    Viewer viewer(parser);
    Rectifier rectifier(parser);
    StereoSource source(parser);

    Ptr<HDPTreeMatcher> matcher;
    Range disparities;
    Mat left, right, disparity;
    Speed speed;
    int frames = 0;
    for (bool goOn = true; goOn && frames < maxFrames && source.read(left, right); ++frames)
    {
        rectifier.apply(left, right);
        if (scale < 1)
        {
            resize(left, left, Size(), scale, scale, INTER_AREA);
            resize(right, right, Size(), scale, scale, INTER_AREA);
        }
        if (!matcher) // kept for all frames, and with it its buffers
        {
            disparities = getDisparities(parser, left.size());
            matcher = HDPTreeMatcher::create(disparities.start, disparities.size(), preset);
            std::cout << format("images     %d x %d, disparities %d to %d", left.cols, left.rows, disparities.start,
                                disparities.end - 1)
                      << std::endl;
        }
        TickMeter timer;
        timer.start();
        matcher->compute(left, right, disparity);
        timer.stop();
        speed.add(timer.getTimeMilli());
        goOn = viewer.show(drawPicture(left, disparity, disparities, speed.text()), source.fps());
    }
    if (frames == 0)
        fail("the source has no frame");
    speed.printTotal();
}

int main(int argc, char** argv)
{
    return runSample(argc, argv, KEYS, "Disparities of a live source: two cameras or videos, or one side by side.\n",
                     FLAGS, 2, run);
}
