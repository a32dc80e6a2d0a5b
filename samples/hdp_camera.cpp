// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// From two cameras to depth: raw pairs of cameras, videos, folders or files, and their calibration, are rectified by
// cv::stereo::StereoRig and matched by cv::stereo::HDPTreeMatcher. Shows the left image beside its disparities, the
// frames per second, and how much disparities flicker: the last frame predicts the next, unless the key t turns that off.
// Writes depth and coloured points, and tells how the rig has drifted since its calibration.

#include "stereo_files.hpp"
#include "stereo_source.hpp"
#include "stereo_view.hpp"
#include "strict_arguments.hpp"

#include <climits>
#include <iostream>
#include <limits>

#include "opencv2/core/utils/logger.hpp"

using namespace cv;
using namespace cv::stereo;
using namespace hdp_samples;

static const char* const keys =
    "{help h ?        |      | print this and exit }"
    "{@left           |      | left images: file, folder, video, pictures (left%02d.jpg), address, number of a camera }"
    "{@right          |      | right images; without it, the left source has both side by side }"
    "{right-first     |      | side by side: the right image is the left half }"
    "{calibration c   |      | of both cameras, or of the left one: OpenCV's intrinsics.yml, ROS's left.yaml, Kalibr's "
    "camchain.yaml, EuRoC's sensor.yaml, the ZED's SN12345.conf; without it, the images are rectified }"
    "{calibration2    |      | its other file: extrinsics.yml, right.yaml, the right camera's sensor.yaml }"
    "{unit            | 1    | metres in the unit of OpenCV's extrinsics.yml }"
    "{field-of-view   | 0    | of the rectified images, in degrees; by default as much as leaves hardly an empty "
    "pixel, with fisheye as much as keeps the focal length }"
    "{scale           | 1    | size of the images to match, relative to those of the source: 0.05 to 1 }"
    "{preset          | fast | set of parameters: ultrafast, fast or quality }"
    "{min-disparity   | 0    | smallest disparity in pixels, after scaling }"
    "{num-disparities |      | number of disparities; by default width / 5, rounded up to a multiple of 16 }"
    "{single-frames   |      | without temporal prediction; the key t turns it on and off }"
    "{watch           |      | print every 20 frames how the right camera has turned since the calibration }"
    "{frames          |      | stop after this many; by default at the end of the source, or at Esc or q }"
    "{results         |      | folder: pairs, disparities, depth (.png in millimetres, .pfm in metres), points }"
    "{output          |      | what is shown: a video (FILE.avi, Motion JPEG) or pictures (FILE%04d.png) }"
    "{no-gui          |      | no window }";

static void fail(const String& message) { CV_Error(Error::StsError, message); }

static int presetOf(const String& name)
{
    if (name != "ultrafast" && name != "fast" && name != "quality")
        fail("--preset=" + name + " is none of ultrafast, fast and quality");
    return name == "ultrafast" ? HDPTreeMatcher::PRESET_ULTRAFAST
           : name == "fast"    ? HDPTreeMatcher::PRESET_FAST
                               : HDPTreeMatcher::PRESET_QUALITY;
}

static double unitOf(const CommandLineParser& parser) { return numberOf(parser, "unit", 0, 1e6); }

static double fieldOfViewOf(const CommandLineParser& parser) { return numberOf(parser, "field-of-view", 0, 170); }

static int minDisparityOf(const CommandLineParser& parser) { return integerOf(parser, "min-disparity", -2047, 2047); }

static int numDisparitiesOf(const CommandLineParser& parser, int width)
{
    return parser.has("num-disparities") ? integerOf(parser, "num-disparities", 0, 4095) : (width / 5 + 15) / 16 * 16;
}

//! The calibrated cameras; none without a calibration
static Ptr<StereoRig> openRig(const CommandLineParser& parser, Size imageSize, Size size)
{
    if (!parser.has("calibration"))
        return Ptr<StereoRig>();
    const StereoCalibration calibration = readStereoCalibration(
        parser.get<String>("calibration"), parser.get<String>("calibration2"), imageSize, unitOf(parser));
    return StereoRig::create(calibration, fieldOfViewOf(parser), size);
}

static Ptr<HDPTreeMatcher> createMatcher(const CommandLineParser& parser, int width, const Ptr<StereoRig>& rig)
{
    const Ptr<HDPTreeMatcher> matcher = HDPTreeMatcher::create(minDisparityOf(parser), numDisparitiesOf(parser, width),
                                                               presetOf(parser.get<String>("preset")));
    matcher->setDisparityDepth(CV_32F); // in pixels
    if (rig)
    {
        Mat leftMask, rightMask; // what no raw pixel reaches has no disparity
        rig->getMasks(leftMask, rightMask);
        matcher->setMasks(leftMask, rightMask);
    }
    return matcher;
}

//! Without a calibration, images are rectified, and only resized.
static void rectify(const Ptr<StereoRig>& rig, Size size, Mat& left, Mat& right)
{
    if (!rig)
    {
        resize(left, left, size, 0, 0, INTER_AREA);
        resize(right, right, size, 0, 0, INTER_AREA);
        return;
    }
    rig->rectify(left, right, left, right);
    if (left.depth() == CV_32F) // whose levels may be far from the 0 of what no raw pixel reaches
    {
        Mat leftMask, rightMask;
        rig->getMasks(leftMask, rightMask);
        left.setTo(std::numeric_limits<float>::quiet_NaN(), leftMask == 0);
        right.setTo(std::numeric_limits<float>::quiet_NaN(), rightMask == 0);
    }
}

//! --watch
static void printDrift(const RigDrift& drift)
{
    std::vector<double> values, deviations;
    drift.getEstimate(values, deviations);
    std::cout << "right camera after " << drift.getFrames() << " frames:";
    const char* const names[] = { " pitch", ", yaw", ", roll", ", focal length" };
    for (int i = 0; i < 4; i++)
        std::cout << format("%s %+.3f +- %.3f %s", names[i], values[i], deviations[i], i < 3 ? "degrees" : "%");
    std::cout << std::endl;
}

//! --results
static void writeFrame(const String& folder, int frame, const Ptr<StereoRig>& rig, const Mat& left, const Mat& right,
                       const Mat& disparity, int minDisparity)
{
    if (frame == 0 && !utils::fs::createDirectories(folder)) // not earlier: what fails before leaves no empty folder
        fail("cannot make the folder '" + folder + "'");
    const bool isFloat = left.depth() == CV_32F; // PNG has none
    writeResults(utils::fs::join(folder, format("%06d_", frame)), rig, isFloat ? colorsOf(left) : left,
                 isFloat ? colorsOf(right) : right, disparity, minDisparity);
}

static void run(const CommandLineParser& parser)
{
    presetOf(parser.get<String>("preset"));
    const int maxFrames = parser.has("frames") ? integerOf(parser, "frames", 1, INT_MAX) : INT_MAX;
    const double scale = numberOf(parser, "scale", 0.05, 1);
    const String results = parser.get<String>("results");
    minDisparityOf(parser); // before a source is opened
    numDisparitiesOf(parser, 0);
    unitOf(parser);
    fieldOfViewOf(parser);
    for (const char* option : { "calibration2", "watch" })
        if (parser.has(option) && !parser.has("calibration"))
            fail("--" + String(option) + " needs --calibration");
    if (!parser.has("@left"))
        fail("a source is needed: a file, a folder, a video or a camera; --help says more");
    Viewer viewer(parser.get<String>("output"), !parser.has("no-gui"));
    StereoSource source(parser.get<String>("@left"), parser.get<String>("@right"), parser.has("right-first"));

    Size size; // of the images that are matched
    Ptr<StereoRig> rig;
    Ptr<RigDrift> drift;
    Ptr<HDPTreeMatcher> matcher; // kept for all frames, and with it its buffers and what it knows of the last frame
    bool isTemporal = !parser.has("single-frames");
    FrameStatistics statistics[2]; // without temporal prediction, and with it
    Mat left, right, disparity;
    TickMeter all;
    all.start();
    int frames = 0, key = -1;
    for (; key != 27 && key != 'q' && frames < maxFrames && source.read(left, right); frames++)
    {
        if (!matcher)
        {
            size = Size(cvRound(left.cols * scale), cvRound(left.rows * scale));
            rig = openRig(parser, left.size(), size);
            matcher = createMatcher(parser, size.width, rig);
            if (rig && parser.has("watch"))
            {
                Mat R1, R2, P1, P2, Q;
                rig->getRectification(R1, R2, P1, P2, Q);
                drift = RigDrift::create(P2, size);
            }
        }
        rectify(rig, size, left, right);
        matcher->setUseTemporalPrediction(isTemporal);
        statistics[isTemporal].start();
        matcher->compute(left, right, disparity);
        statistics[isTemporal].stop(left, disparity);
        const HDPTreeMatcher::Findings findings = matcher->getFindings();
        if (drift)
        {
            drift->add(findings.rows);
            if ((frames + 1) % 20 == 0)
                printDrift(*drift);
        }
        if (!results.empty())
            writeFrame(results, frames, rig, left, right, disparity, findings.minDisparity);
        all.stop(); // and on, for the time until now
        all.start();
        const std::vector<String> lines = { format("%.1f frames/s", (frames + 1) / all.getTimeSec()),
                                            "single: " + statistics[0].text(), "temporal: " + statistics[1].text() };
        key = viewer.show(drawPicture(left, disparity, findings, lines), source.fps());
        if (key == 't')
        {
            isTemporal = !isTemporal;
            statistics[isTemporal].interrupt();
        }
    }
    all.stop();
    if (frames == 0)
        fail("the source has no frame");
    if (drift)
        printDrift(*drift);
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
        checkArguments(argc, argv, parser, 2);
        run(parser);
    }
    catch (const cv::Exception& e)
    {
        std::cerr << "error: " << e.err << std::endl;
        return 1;
    }
    return 0;
}
