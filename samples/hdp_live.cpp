// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches a live source with cv::stereo::HDPTreeMatcher: two cameras or videos, or one that has both images side by side.
// Shows the left image beside its disparities, the frames per second, and how much the disparities flicker: the last frame
// predicts the next, unless the key t turns that off.

#include <cstdlib>
#include <iostream>

#include "opencv2/core/utility.hpp"
#include "opencv2/core/utils/logger.hpp"
#include "opencv2/hdpstereo.hpp"
#include "opencv2/imgproc.hpp"
#include "opencv2/opencv_modules.hpp"
#include "opencv2/videoio.hpp"
#ifdef HAVE_OPENCV_HIGHGUI
#include "opencv2/highgui.hpp"
#endif

using namespace cv;
using cv::stereo::HDPTreeMatcher;

static const char* const keys =
    "{help h ?        |      | print this and exit }"
    "{@left           |      | left images: a video, pictures by number (left%02d.jpg), an address, or a camera's "
    "number }"
    "{@right          |      | right images; without it, the left source has both side by side }"
    "{right-first     |      | side by side: the right image is the left half }"
    "{intrinsics i    |      | calibration as stereo_calib.cpp of OpenCV's samples writes it: M1, D1, M2, D2; without "
    "it, the images are rectified }"
    "{extrinsics e    |      | its other file: R, T }"
    "{scale           | 1    | size of the images to match, relative to those of the source: 0.05 to 1 }"
    "{preset          | fast | set of parameters: ultrafast, fast or quality }"
    "{min-disparity   | 0    | smallest disparity in pixels, after scaling }"
    "{num-disparities |      | number of disparities; by default width / 5, rounded up to a multiple of 16 }"
    "{single-frames   |      | without temporal prediction; the key t turns it on and off }"
    "{frames          |      | stop after this many; by default at the end of the source, or at Esc or q }"
    "{output          |      | what is shown: a video (FILE.avi, Motion JPEG) or pictures (FILE%04d.png) }"
    "{no-gui          |      | no window }";

static void fail(const String& message) { CV_Error(Error::StsError, message); }

//! Where the pairs come from
class StereoSource
{
public:
    explicit StereoSource(const CommandLineParser& parser)
        : sideBySide_(!parser.has("@right")), rightFirst_(parser.has("right-first"))
    {
        open(parser.get<String>("@left"), left_);
        if (!sideBySide_)
            open(parser.get<String>("@right"), right_);
    }

    //! Returns false at the end.
    bool read(Mat& left, Mat& right)
    {
        // Both are grabbed before one is decoded, so that two cameras see the same moment.
        if (!left_.grab() || (!sideBySide_ && !right_.grab()) || !left_.retrieve(frame_))
            return false;
        if (!sideBySide_)
        {
            left = frame_;
            return right_.retrieve(right);
        }
        const int half = frame_.cols / 2;
        left = frame_.colRange(0, half);
        right = frame_.colRange(half, 2 * half);
        if (rightFirst_)
            swap(left, right);
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
        const bool isCamera = !name.empty() && name.find_first_not_of("0123456789") == String::npos;
        if (isCamera ? !capture.open(std::atoi(name.c_str())) : !capture.open(name))
            fail("cannot open the " + String(isCamera ? "camera " : "source ") + name);
    }

    bool sideBySide_, rightFirst_;
    VideoCapture left_, right_;
    Mat frame_;
};

//! Brings both images onto the same rows, by the maps of a calibration; without one it leaves them alone.
class Rectifier
{
public:
    explicit Rectifier(const CommandLineParser& parser)
    {
        if (!parser.has("intrinsics") && !parser.has("extrinsics"))
            return;
        const FileStorage in(parser.get<String>("intrinsics"), FileStorage::READ),
            out(parser.get<String>("extrinsics"), FileStorage::READ);
        if (!in.isOpened() || !out.isOpened())
            fail("cannot read the calibration, which is --intrinsics and --extrinsics");
        in["M1"] >> M_[0];
        in["D1"] >> D_[0];
        in["M2"] >> M_[1];
        in["D2"] >> D_[1];
        out["R"] >> R_;
        out["T"] >> T_;
        if (R_.empty() || T_.empty())
            fail("--extrinsics has no R or no T");
    }

    void apply(Mat& left, Mat& right)
    {
        if (R_.empty())
            return;
        if (maps_[0][0].empty())
        {
            Mat R[2], P[2], Q;
            stereoRectify(M_[0], D_[0], M_[1], D_[1], left.size(), R_, T_, R[0], R[1], P[0], P[1], Q);
            for (int i = 0; i < 2; i++)
                initUndistortRectifyMap(M_[i], D_[i], R[i], P[i], left.size(), CV_16SC2, maps_[i][0], maps_[i][1]);
        }
        Mat rectified[2];
        remap(left, rectified[0], maps_[0][0], maps_[0][1], INTER_LINEAR);
        remap(right, rectified[1], maps_[1][0], maps_[1][1], INTER_LINEAR);
        left = rectified[0];
        right = rectified[1];
    }

private:
    Mat M_[2], D_[2], R_, T_, maps_[2][2];
};

//! Where the pictures go: a window, a file, or neither
class Viewer
{
public:
    explicit Viewer(const CommandLineParser& parser)
        : path_(parser.get<String>("output")), hasWindow_(!parser.has("no-gui") && haveDisplay())
    {
    }

    //! Returns the key that was pressed; -1 if there is none.
    int show(const Mat& picture, double fps)
    {
        if (!path_.empty() && !writer_.isOpened())
        {
            const bool isSequence = path_.find('%') != String::npos;
            const int codec = isSequence ? 0 : VideoWriter::fourcc('M', 'J', 'P', 'G');
            if (!writer_.open(path_, isSequence ? CAP_IMAGES : CAP_ANY, codec, isSequence ? 0 : fps, picture.size()))
                fail("cannot write '" + path_ + "'");
        }
        if (!path_.empty())
            writer_.write(picture);
#ifdef HAVE_OPENCV_HIGHGUI
        if (hasWindow_)
        {
            imshow("hdp_live", picture);
            return waitKey(1);
        }
#endif
        return -1;
    }

private:
    //! A window without a display may end the program, not just throw.
    static bool haveDisplay()
    {
#if defined HAVE_OPENCV_HIGHGUI && defined __unix__ && !defined __APPLE__
        return std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY") || std::getenv("QT_QPA_PLATFORM");
#else
        return true;
#endif
    }

    const String path_;
    bool hasWindow_;
    VideoWriter writer_;
};

static int presetOf(const String& name)
{
    if (name != "ultrafast" && name != "fast" && name != "quality")
        fail("--preset=" + name + ": neither ultrafast nor fast, quality");
    return name == "fast"      ? HDPTreeMatcher::PRESET_FAST
           : name == "quality" ? HDPTreeMatcher::PRESET_QUALITY
                               : HDPTreeMatcher::PRESET_ULTRAFAST;
}

//! An image as it is shown, in colors of 8 bit. Cameras and pictures may have grey levels, also in 16 bit.
static Mat colorsOf(const Mat& image)
{
    Mat colors = image;
    if (image.depth() == CV_16U)
        normalize(image, colors, 0, 255, NORM_MINMAX, CV_8U);
    if (colors.channels() != 3)
        cvtColor(colors, colors, colors.channels() == 1 ? COLOR_GRAY2BGR : COLOR_BGRA2BGR);
    return colors;
}

//! The left image beside its disparities, from blue (far) to orange (near)
static Mat drawPicture(const Mat& left, const Mat& disparity16, const HDPTreeMatcher& matcher,
                       const std::vector<String>& lines)
{
    const int smallest = 16 * matcher.getMinDisparity(), range = 16 * matcher.getNumDisparities();
    Mat levels, colors, color, picture;
    disparity16.convertTo(levels, CV_8U, 150. / range, 20 - 150. / range * smallest);
    applyColorMap(levels, colors, COLORMAP_TURBO);
    colors.setTo(Scalar::all(0), disparity16 < smallest);
    hconcat(colorsOf(left), colors, picture);
    const double size = std::max(picture.cols / 1280., 0.4);
    for (size_t i = 0; i < lines.size(); i++)
    {
        const Point origin(cvRound(12 * size), cvRound(30 * size * (i + 1)));
        for (const bool isOutline : { true, false })
            putText(picture, lines[i], origin, FONT_HERSHEY_SIMPLEX, size, Scalar::all(isOutline ? 0 : 255),
                    cvRound(isOutline ? 4 * size + 1 : size), LINE_AA);
    }
    return picture;
}

//! What is measured without temporal prediction, or with it
class Statistics
{
public:
    void match(HDPTreeMatcher& matcher, const Mat& left, const Mat& right, Mat& disparity16)
    {
        timer_.start();
        matcher.compute(left, right, disparity16);
        timer_.stop();
        Mat grey, disparity;
        cvtColor(colorsOf(left), grey, COLOR_BGR2GRAY);
        GaussianBlur(grey, grey, Size(), 2);
        disparity16.convertTo(disparity, CV_32F, 1. / 16);
        if (!lastGrey_.empty())
            addFlicker(grey, disparity);
        lastGrey_ = grey;
        lastDisparity_ = disparity;
    }

    //! The next frame does not follow the last one.
    void interrupt() { lastGrey_.release(); }

    String text() const
    {
        const String time = timer_.getCounter() > 0 ? format("%.1f ms", timer_.getAvgTimeMilli()) : String("-");
        return frames_ > 0 ? time + format(", flicker %.2f px", flicker_) : time;
    }

private:
    //! How much disparities change from frame to frame where the image stands still: a mean of the last frames
    void addFlicker(const Mat& grey, const Mat& disparity)
    {
        const double stillLevels = 3;
        const int meanOf = 20;
        Mat change, isStill;
        absdiff(grey, lastGrey_, change);
        isStill = change < stillLevels;
        absdiff(disparity, lastDisparity_, change);
        frames_ = std::min(frames_ + 1, meanOf);
        flicker_ += (mean(change, isStill)[0] - flicker_) / frames_;
    }

    TickMeter timer_;
    Mat lastGrey_, lastDisparity_;
    double flicker_ = 0;
    int frames_ = 0;
};

static void run(const CommandLineParser& parser)
{
    const int preset = presetOf(parser.get<String>("preset")), minDisparity = parser.get<int>("min-disparity");
    const int maxFrames = parser.has("frames") ? parser.get<int>("frames") : INT_MAX;
    const double scale = parser.get<double>("scale");
    if (!parser.check() || !(scale >= 0.05 && scale <= 1))
        fail("--scale must be from 0.05 to 1, --frames and --min-disparity whole numbers");
    Viewer viewer(parser);
    Rectifier rectifier(parser);
    StereoSource source(parser);

    Ptr<HDPTreeMatcher> matcher; // kept for all frames, and with it its buffers and what it knows of the last frame
    bool isTemporal = !parser.has("single-frames");
    Statistics statistics[2]; // without temporal prediction, and with it
    Mat left, right, disparity;
    TickMeter all;
    all.start();
    int frames = 0, key = -1;
    for (; key != 27 && key != 'q' && frames < maxFrames && source.read(left, right); frames++)
    {
        rectifier.apply(left, right);
        resize(left, left, Size(), scale, scale, INTER_AREA);
        resize(right, right, Size(), scale, scale, INTER_AREA);
        if (!matcher)
        {
            const int numDisparities = parser.has("num-disparities") ? parser.get<int>("num-disparities")
                                                                     : std::max((left.cols / 5 + 15) / 16 * 16, 16);
            matcher = HDPTreeMatcher::create(minDisparity, numDisparities, preset);
        }
        matcher->setUseTemporalPrediction(isTemporal);
        statistics[isTemporal].match(*matcher, left, right, disparity);
        all.stop(); // and on, for the time until now
        all.start();
        const std::vector<String> lines = { format("%.1f frames/s", (frames + 1) / all.getTimeSec()),
                                            "single: " + statistics[0].text(), "temporal: " + statistics[1].text() };
        key = viewer.show(drawPicture(left, disparity, *matcher, lines), source.fps());
        if (key == 't')
        {
            isTemporal = !isTemporal;
            statistics[isTemporal].interrupt();
        }
    }
    all.stop();
    if (frames == 0)
        fail("the source has no frame");
    std::cout << format("%d frames, %.1f frames/s, matching ", frames, frames / all.getTimeSec())
              << statistics[isTemporal].text() << std::endl;
    if (!std::cout)
        fail("cannot write to the standard output");
}

int main(int argc, char** argv)
{
    utils::logging::setLogLevel(utils::logging::LOG_LEVEL_SILENT); // errors are reported below
    CommandLineParser parser(argc, argv, keys);
    parser.about("Disparities of a live source: two cameras or videos, or one side by side.");
    if (parser.has("help"))
    {
        parser.printMessage();
        return 0;
    }
    try
    {
        run(parser);
    }
    catch (const cv::Exception& e)
    {
        std::cerr << "error: " << e.err << std::endl;
        return 1;
    }
    return 0;
}
