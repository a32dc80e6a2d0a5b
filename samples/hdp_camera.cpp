// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// From two cameras to depth: raw pairs of cameras, videos, folders or files, and their calibration, are rectified by
// cv::stereo::StereoRig and matched by cv::stereo::HDPTreeMatcher. Shows the left image beside its disparities, the frames
// per second, and how much the disparities flicker: the last frame predicts the next, unless the key t turns that off.
// Writes depth and coloured points, and tells how the rig has drifted since its calibration.

#include <cstdlib>
#include <fstream>
#include <iostream>

#include "opencv2/core/utility.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/core/utils/logger.hpp"
#include "opencv2/hdpstereo.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"
#include "opencv2/opencv_modules.hpp"
#include "opencv2/videoio.hpp"
#ifdef HAVE_OPENCV_HIGHGUI
#include "opencv2/highgui.hpp"
#endif

using namespace cv;
using cv::stereo::HDPTreeMatcher;
using cv::stereo::RigDrift;
using cv::stereo::StereoRig;

static const char* const keys =
    "{help h ?        |      | print this and exit }"
    "{@left           |      | left images: a file, a folder, a video, pictures by number (left%02d.jpg), an address, "
    "or a "
    "camera's number }"
    "{@right          |      | right images; without it, the left source has both side by side }"
    "{right-first     |      | side by side: the right image is the left half }"
    "{calibration c   |      | of both cameras, or of the left one: OpenCV's intrinsics.yml, ROS's left.yaml, Kalibr's "
    "camchain.yaml, EuRoC's sensor.yaml, the ZED's SN12345.conf; without it, the images are rectified }"
    "{calibration2    |      | its other file: extrinsics.yml, right.yaml, the right camera's sensor.yaml }"
    "{unit            | 1    | metres in the unit of OpenCV's extrinsics.yml }"
    "{field-of-view   | 0    | of the rectified images, in degrees; by default as much as leaves no empty pixels, with "
    "fisheye as much as keeps the focal length }"
    "{scale           | 1    | size of the images to match, relative to those of the source: 0.05 to 1 }"
    "{preset          | fast | set of parameters: ultrafast, fast or quality }"
    "{min-disparity   | 0    | smallest disparity in pixels, after scaling }"
    "{num-disparities |      | number of disparities; by default width / 5, rounded up to a multiple of 16 }"
    "{single-frames   |      | without temporal prediction; the key t turns it on and off }"
    "{watch           |      | print every 20 frames how the right camera has turned since the calibration }"
    "{frames          |      | stop after this many; by default at the end of the source, or at Esc or q }"
    "{results         |      | a folder: of each frame the rectified pair, disparities (.pfm), depth (.png in "
    "millimetres, "
    ".pfm in metres) and points (.ply) }"
    "{output          |      | what is shown: a video (FILE.avi, Motion JPEG) or pictures (FILE%04d.png) }"
    "{no-gui          |      | no window }";

static void fail(const String& message) { CV_Error(Error::StsError, message); }

//! Images one after the other: of a file, a folder, or what cv::VideoCapture knows
class ImageSource
{
public:
    void open(const String& name)
    {
        if (utils::fs::isDirectory(name))
            glob(utils::fs::join(name, "*"), files_); // in the order of their names
        else if (haveImageReader(name))
            files_.push_back(name);
        else
        {
            const bool isCamera = !name.empty() && name.find_first_not_of("0123456789") == String::npos;
            if (isCamera ? !capture_.open(std::atoi(name.c_str())) : !capture_.open(name))
                fail("cannot open the " + String(isCamera ? "camera " : "source ") + name);
        }
    }

    bool grab() { return capture_.isOpened() ? capture_.grab() : next_ < files_.size(); }

    bool retrieve(Mat& image)
    {
        if (capture_.isOpened())
            return capture_.retrieve(image);
        image = imread(files_[next_], IMREAD_ANYCOLOR | IMREAD_ANYDEPTH);
        if (image.empty())
            fail("cannot read the image '" + files_[next_] + "'");
        next_++;
        return true;
    }

    double fps() const
    {
        const double fps = capture_.get(CAP_PROP_FPS);
        return fps >= 1 && fps <= 1000 ? fps : 25; // cameras and pictures may not know
    }

private:
    VideoCapture capture_;
    std::vector<String> files_;
    size_t next_ = 0;
};

//! Where the pairs come from
class StereoSource
{
public:
    explicit StereoSource(const CommandLineParser& parser)
        : sideBySide_(!parser.has("@right")), rightFirst_(parser.has("right-first"))
    {
        left_.open(parser.get<String>("@left"));
        if (!sideBySide_)
            right_.open(parser.get<String>("@right"));
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

    double fps() const { return left_.fps(); }

private:
    const bool sideBySide_, rightFirst_;
    ImageSource left_, right_;
    Mat frame_;
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
            imshow("hdp_camera", picture);
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
static Mat drawPicture(const Mat& left, const Mat& disparity, const HDPTreeMatcher& matcher,
                       const std::vector<String>& lines)
{
    const HDPTreeMatcher::Findings findings = matcher.getFindings();
    const int smallest = findings.minDisparity, range = findings.numDisparities;
    Mat levels, colors, picture;
    disparity.convertTo(levels, CV_8U, 150. / range, 20 - 150. / range * smallest);
    applyColorMap(levels, colors, COLORMAP_TURBO);
    colors.setTo(Scalar::all(0), disparity < smallest);
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
    void match(HDPTreeMatcher& matcher, const Mat& left, const Mat& right, Mat& disparity)
    {
        timer_.start();
        matcher.compute(left, right, disparity);
        timer_.stop();
        Mat grey;
        cvtColor(colorsOf(left), grey, COLOR_BGR2GRAY);
        GaussianBlur(grey, grey, Size(), 2);
        if (!lastGrey_.empty())
            addFlicker(grey, disparity);
        lastGrey_ = grey;
        lastDisparity_ = disparity.clone();
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

//! A binary .ply file of the points that have a depth
static void writePoints(const String& path, const Mat& disparity, const Mat& depth, const Mat& colors, const Mat& Q)
{
    Mat points;
    reprojectImageTo3D(disparity, points, Q);
    std::ofstream file(path.c_str(), std::ios::binary);
    file << "ply\nformat binary_little_endian 1.0\nelement vertex " << countNonZero(depth == depth)
         << "\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
    for (int y = 0; y < depth.rows; y++)
        for (int x = 0; x < depth.cols; x++)
            if (!cvIsNaN(depth.at<float>(y, x)))
            {
                const Vec3b bgr = colors.at<Vec3b>(y, x), rgb(bgr[2], bgr[1], bgr[0]);
                file.write((const char*)points.ptr(y, x), sizeof(Vec3f));
                file.write((const char*)rgb.val, sizeof(rgb.val));
            }
    if (!file.flush())
        fail("cannot write '" + path + "'");
}

static void writeImage(const String& path, const Mat& image)
{
    if (!imwrite(path, image))
        fail("cannot write '" + path + "'");
}

//! The calibrated cameras; without a calibration, images are only resized, and have no depth.
class Cameras
{
public:
    Cameras(const CommandLineParser& parser, Size imageSize)
        : scale_(parser.get<double>("scale")), results_(parser.get<String>("results"))
    {
        if (!parser.has("calibration"))
            return;
        const Size size(cvRound(imageSize.width * scale_), cvRound(imageSize.height * scale_));
        rig_ = StereoRig::create(cv::stereo::readStereoCalibration(parser.get<String>("calibration"),
                                                                   parser.get<String>("calibration2"), imageSize,
                                                                   parser.get<double>("unit")),
                                 parser.get<double>("field-of-view"), size);
        rig_->getRectification(R1_, R2_, P1_, P2_, Q_);
        if (parser.has("watch"))
            drift_ = RigDrift::create(P2_, size);
    }

    void rectify(Mat& left, Mat& right) const
    {
        if (rig_)
            return rig_->rectify(left, right, left, right);
        resize(left, left, Size(), scale_, scale_, INTER_AREA);
        resize(right, right, Size(), scale_, scale_, INTER_AREA);
    }

    //! What no raw pixel reaches has no disparity.
    void setMasks(HDPTreeMatcher& matcher) const
    {
        Mat masks[2];
        if (rig_)
            rig_->getMasks(masks[0], masks[1]);
        matcher.setMasks(masks[0], masks[1]);
    }

    //! --watch: takes a frame into account.
    void watch(const HDPTreeMatcher& matcher, int frame)
    {
        if (!drift_)
            return;
        drift_->add(matcher.getFindings().rows);
        if (frame % 20 == 0)
            printDrift();
    }

    void printDrift() const
    {
        if (!drift_)
            return;
        std::vector<double> values, deviations;
        drift_->getEstimate(values, deviations);
        std::cout << "right camera after " << drift_->getFrames() << " frames:";
        const char* const names[] = { " pitch", ", yaw", ", roll", ", focal length" };
        for (int i = 0; i < 4; i++)
            std::cout << format("%s %+.3f +- %.3f %s", names[i], values[i], deviations[i], i < 3 ? "degrees" : "%");
        std::cout << std::endl;
    }

    //! --results
    void write(int frame, const HDPTreeMatcher& matcher, const Mat& left, const Mat& right, const Mat& disparity) const
    {
        if (results_.empty())
            return;
        const String base = utils::fs::join(results_, format("%06d_", frame));
        writeImage(base + "left.png", left);
        writeImage(base + "right.png", right);
        writeImage(base + "disparity.pfm", disparity);
        if (!rig_)
            return;
        Mat metres, millimetres;
        const int smallest = matcher.getFindings().minDisparity;
        rig_->computeDepth(disparity, metres, CV_32F, smallest);
        rig_->computeDepth(disparity, millimetres, CV_16U, smallest);
        writeImage(base + "depth.pfm", metres);
        writeImage(base + "depth.png", millimetres);
        writePoints(base + "points.ply", disparity, metres, colorsOf(left), Q_);
    }

private:
    const double scale_;
    const String results_;
    Ptr<StereoRig> rig_;
    Ptr<RigDrift> drift_;
    Mat R1_, R2_, P1_, P2_, Q_;
};

static Ptr<HDPTreeMatcher> createMatcher(const CommandLineParser& parser, int width)
{
    const int numDisparities =
        parser.has("num-disparities") ? parser.get<int>("num-disparities") : std::max((width / 5 + 15) / 16 * 16, 16);
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(parser.get<int>("min-disparity"), numDisparities,
                                                               presetOf(parser.get<String>("preset")));
    matcher->setDisparityDepth(CV_32F);
    return matcher;
}

static void run(const CommandLineParser& parser)
{
    presetOf(parser.get<String>("preset"));
    const int maxFrames = parser.has("frames") ? parser.get<int>("frames") : INT_MAX;
    const double scale = parser.get<double>("scale");
    const String results = parser.get<String>("results");
    if (!parser.check() || !(scale >= 0.05 && scale <= 1))
        fail("--scale must be from 0.05 to 1, --frames and --min-disparity whole numbers");
    if (!results.empty() && !utils::fs::createDirectories(results))
        fail("cannot make the folder '" + results + "'");
    Viewer viewer(parser);
    StereoSource source(parser);

    Ptr<HDPTreeMatcher> matcher; // kept for all frames, and with it its buffers and what it knows of the last frame
    Ptr<Cameras> cameras;
    bool isTemporal = !parser.has("single-frames");
    Statistics statistics[2]; // without temporal prediction, and with it
    Mat left, right, disparity;
    TickMeter all;
    all.start();
    int frames = 0, key = -1;
    for (; key != 27 && key != 'q' && frames < maxFrames && source.read(left, right); frames++)
    {
        if (!cameras)
            cameras = makePtr<Cameras>(parser, left.size());
        cameras->rectify(left, right);
        if (!matcher)
        {
            matcher = createMatcher(parser, left.cols);
            cameras->setMasks(*matcher);
        }
        matcher->setUseTemporalPrediction(isTemporal);
        statistics[isTemporal].match(*matcher, left, right, disparity);
        cameras->watch(*matcher, frames + 1);
        cameras->write(frames, *matcher, left, right, disparity);
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
    cameras->printDrift();
    std::cout << format("%d frames, %.1f frames/s, matching ", frames, frames / all.getTimeSec())
              << statistics[isTemporal].text() << std::endl;
    if (!std::cout)
        fail("cannot write to the standard output");
}

int main(int argc, char** argv)
{
    utils::logging::setLogLevel(utils::logging::LOG_LEVEL_SILENT); // errors are reported below
    CommandLineParser parser(argc, argv, keys);
    parser.about("From two cameras to depth: rectified pairs, disparities, points, and the drift of the rig.");
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
