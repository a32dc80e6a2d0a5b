// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "files.hpp"
#include "rectifier.hpp"
#include "windows.hpp"

#include <algorithm>
#include <iostream>

#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

using namespace cv;
using cv::stereo::HDPTreeMatcher;
using cv::stereo::StereoRig;

static void writeAndTell(const String& path, const std::vector<uchar>& bytes)
{
    writeWholeFile(path, bytes);
    std::cout << "written    " << path << std::endl;
}

//! For points: in 8 bit, from black to the brightest of the pixels that have a disparity; others may be no data
static Mat colorsOf(const Mat& image, const Mat& known)
{
    if (image.type() == CV_8UC3)
        return image;
    double least = 0, most = 0;
    minMaxLoc(image, &least, &most, nullptr, nullptr, known);
    const double scale = most > least ? 255 / (most - least) : 0;
    Mat colors;
    image.convertTo(colors, CV_8U, scale, -scale * least);
    cvtColor(colors, colors, COLOR_GRAY2BGR);
    return colors;
}

//! By the matcher that this one takes the place of. It leaves out as many columns on the left as there are disparities,
//! so the images are extended by these.
static Mat computeLikeSGBM(const HDPTreeMatcher& matcher, const Mat& left, const Mat& right, double& milliseconds)
{
    const HDPTreeMatcher::Findings findings = matcher.getFindings();
    const int minDisparity = findings.minDisparity, numDisparities = (findings.numDisparities + 15) / 16 * 16;
    const int added = std::max(minDisparity + numDisparities, 0);
    const Ptr<StereoSGBM> sgbm =
        StereoSGBM::create(minDisparity, numDisparities, 3, 8 * 27, 32 * 27, 0, 0, 0, 0, 0, StereoSGBM::MODE_SGBM_3WAY);
    Mat wideLeft, wideRight, disparity16;
    copyMakeBorder(left, wideLeft, 0, 0, added, 0, BORDER_REPLICATE);
    copyMakeBorder(right, wideRight, 0, 0, added, 0, BORDER_REPLICATE);
    TickMeter clock;
    clock.start();
    sgbm->compute(wideLeft, wideRight, disparity16);
    clock.stop();
    milliseconds = clock.getTimeMilli();
    return inPixels(disparity16.colRange(added, disparity16.cols), minDisparity);
}

//! If it was found
static void printRange(const HDPTreeMatcher& matcher)
{
    const HDPTreeMatcher::Findings findings = matcher.getFindings();
    if (matcher.getNumDisparities() == 0)
        std::cout << format("%-11sdisparities %d..%d\n", "found", findings.minDisparity,
                            findings.minDisparity + findings.numDisparities - 1);
}

static void printTimes(const HDPTreeMatcher& matcher)
{
    const HDPTreeMatcher::Findings findings = matcher.getFindings();
    double sum = 0;
    for (size_t i = 0; i < findings.stages.size(); i++)
    {
        std::cout << format("%-11s%-24s%10.1f ms\n", i == 0 ? "time" : "", findings.stages[i].c_str(),
                            findings.stageTimes[i]);
        sum += findings.stageTimes[i];
    }
    std::cout << format("%-11s%-24s%10.1f ms\n", "", "all stages", sum);
}

//! If rows tell that something is wrong with the pair. A swapped one has hardly a corner in common, or by chance.
static void warnOfPair(const HDPTreeMatcher& matcher)
{
    const HDPTreeMatcher::Findings findings = matcher.getFindings();
    const double believable = 3, believableError = 1; // pixels
    if (matcher.getMaxRowOffset() == 0)
        return;
    if (findings.rowError == 0) // too few corners were matched
        std::cerr
            << "warning: hardly a corner of the left image was found in the right one: are the two swapped, the pair "
               "not rectified, or --min-disparity and --num-disparities not those of the scene?\n";
    else if (std::abs(findings.rows[0]) > believable)
        std::cerr << format("warning: the rows of the right image are off by %.1f pixels: is the pair rectified, or "
                            "swapped?\n",
                            std::abs(findings.rows[0]));
    else if (findings.rowError > believableError)
        std::cerr << format(
            "warning: corners are %.1f pixels off their rows in the right image: is the pair rectified, "
            "or swapped?\n",
            findings.rowError);
}

//! Pixels of known truth that the right image shows: inside of it, and behind no other pixel
static Mat visiblePixels(const Mat& truth)
{
    Mat visible(truth.size(), CV_8U, Scalar(0));
    for (int y = 0; y < truth.rows; y++)
    {
        float nearest = (float)truth.cols; // column in the right image of what is nearer, to the right of x
        for (int x = truth.cols - 1; x >= 0; x--)
            if (truth.at<float>(y, x) != 0)
            {
                const float column = x - truth.at<float>(y, x);
                visible.at<uchar>(y, x) = column >= 0 && column < nearest ? 255 : 0;
                nearest = std::min(nearest, column);
            }
    }
    return visible;
}

static Mat readTruth(const String& path, Size size)
{
    const Mat image = readImage(path, IMREAD_GRAYSCALE | IMREAD_ANYDEPTH);
    if (image.depth() != CV_8U && image.depth() != CV_16U)
        CV_Error(Error::StsUnsupportedFormat, "--truth must be a PNG of 8 or 16 bits per pixel");
    if (image.size() != size)
        CV_Error(Error::StsUnmatchedSizes, format("--truth must have the size of the images, %d x %d, not %d x %d",
                                                  size.width, size.height, image.cols, image.rows));
    Mat truth;
    image.convertTo(truth, CV_32F, image.depth() == CV_16U ? 1. / 256 : 1);
    if (countNonZero(visiblePixels(truth)) == 0)
        CV_Error(Error::StsBadArg, "--truth must have disparities that both images show");
    return truth;
}

//! Pixels without a disparity are wrong.
static void printErrors(const char* matcher, const Mat& disparity, const Mat& truth)
{
    const Mat known = truth != 0, visible = visiblePixels(truth), error = abs(disparity - truth);
    for (int threshold = 1; threshold <= 2; threshold++)
        std::cout << format("%-11serr>=%d  %-17s%10.2f %% of the pixels that both images show, %.2f %% of all\n",
                            threshold == 1 ? "wrong" : "", threshold, matcher,
                            100. * countNonZero((error >= threshold) & visible) / countNonZero(visible),
                            100. * countNonZero((error >= threshold) & known) / countNonZero(known));
}

//! From blue by green to orange; both ends of the color map are left out.
static Mat colorPicture(const Mat& disparity, const Mat& known)
{
    Mat levels, picture;
    normalize(disparity, levels, 20, 170, NORM_MINMAX, CV_8U, known);
    applyColorMap(levels, picture, COLORMAP_TURBO);
    picture.setTo(Scalar::all(0), ~known);
    return picture;
}

//! A binary .ply file
static std::vector<uchar> pointCloud(const Mat& disparity, const Mat& known, const Mat& image, const Matx44d& Q)
{
    Mat points;
    reprojectImageTo3D(disparity, points, Q);
    Mat z;
    extractChannel(points, z, 2);
    const Mat finite = known & (z > 0) & (z < std::numeric_limits<float>::infinity()); // else it is behind the cameras
    const ushort one = 1; // its first byte tells the order of bytes in floats
    const char* const endian = *reinterpret_cast<const uchar*>(&one) == 1 ? "little" : "big";
    const String header = format("ply\nformat binary_%s_endian 1.0\nelement vertex %d\n"
                                 "property float x\nproperty float y\nproperty float z\n"
                                 "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
                                 endian, countNonZero(finite));
    std::vector<uchar> bytes(header.begin(), header.end());
    for (int y = 0; y < points.rows; y++)
        for (int x = 0; x < points.cols; x++)
            if (finite.at<uchar>(y, x))
            {
                const uchar *const point = points.ptr(y, x), *const bgr = image.ptr(y, x);
                bytes.insert(bytes.end(), point, point + sizeof(Vec3f));
                bytes.insert(bytes.end(), { bgr[2], bgr[1], bgr[0] });
            }
    return bytes;
}

//! From disparities to points
static Matx44d readQ(const CommandLineParser& parser, const Ptr<StereoRig>& rig, Size size)
{
    if (rig)
    {
        Mat R1, R2, P1, P2, Q;
        rig->getRectification(R1, R2, P1, P2, Q);
        return Q;
    }
    if (!parser.has("reprojection"))
    {
        const double f = numberOf(parser, "focal"), B = numberOf(parser, "baseline");
        return Matx44d(1, 0, 0, -0.5 * (size.width - 1), 0, 1, 0, -0.5 * (size.height - 1), 0, 0, 0, f, 0, 0, 1 / B, 0);
    }
    const String path = parser.get<String>("reprojection");
    requireFile(path);
    Mat Q;
    try
    {
        Q = FileStorage(path, FileStorage::READ)["Q"].mat();
    }
    catch (const cv::Exception&) // which does not name the file
    {
    }
    if (Q.size() != Size(4, 4) || Q.channels() != 1 || !checkRange(Q))
        CV_Error(Error::StsParseError, "'" + path + "' has no matrix Q of 4 x 4 finite numbers");
    return Q;
}

static void checkOptions(const CommandLineParser& parser)
{
    if (!parser.has("@left") || !parser.has("@right"))
        CV_Error(Error::StsBadArg, "two images are needed, LEFT and RIGHT; --help says more");
    if (parser.has("output") && parser.has("@out"))
        CV_Error(Error::StsBadArg, "disparities go to one file: OUT or --output, not both");
    if (parser.has("point-cloud") && !parser.has("calibration") && !parser.has("reprojection") &&
        !(parser.has("focal") && parser.has("baseline")))
        CV_Error(Error::StsBadArg, "--point-cloud needs --calibration, --reprojection, or --focal and --baseline");
    if (parser.has("depth") && !parser.has("calibration"))
        CV_Error(Error::StsBadArg, "--depth needs --calibration");
    for (const char* option : { "min-disparity", "num-disparities" })
        if (parser.has(option))
            integerOf(parser, option);
    checkOutputs(parser);
    for (const char* option : { "focal", "baseline" })
        if (parser.has(option) && !(numberOf(parser, option) > 0))
            CV_Error(Error::StsBadArg, format("--%s must be above 0", option));
}

static void writePicture(const String& path, const Mat& left, const Mat& sgbm, const Mat& disparity)
{
    const float none = std::numeric_limits<float>::infinity();
    Mat picture = colorPicture(disparity, disparity < none);
    if (!sgbm.empty())
    {
        // In one scale of colours
        Mat both, colors;
        hconcat(sgbm, disparity, both);
        hconcat(colorsOf(left, disparity < none), colorPicture(both, both < none), picture);
    }
    writeAndTell(path, encode(extensionOf(path), picture));
}

static void writeDepth(const String& path, const StereoRig& rig, const Mat& disparity, int minDisparity)
{
    Mat depth;
    rig.computeDepth(disparity, depth, extensionOf(path) == ".png" ? CV_16U : CV_32F, minDisparity);
    writeAndTell(path, encode(extensionOf(path), depth));
}

//! --sigma, --confidence and --reasons
static void writeReliability(const CommandLineParser& parser, const HDPTreeMatcher& matcher)
{
    if (parser.has("sigma"))
    {
        const String path = parser.get<String>("sigma");
        Mat sigma;
        matcher.getDisparitySigma(sigma);
        writeAndTell(path, encodeDisparity(extensionOf(path), sigma));
    }
    for (const char* option : { "confidence", "reasons" })
        if (parser.has(option))
        {
            const String path = parser.get<String>(option);
            Mat numbers;
            if (option == String("reasons"))
                matcher.getReasons(numbers);
            else
                matcher.getConfidence(numbers);
            if (extensionOf(path) != ".png")
                numbers.convertTo(numbers, CV_32F);
            writeAndTell(path, encode(extensionOf(path), numbers));
        }
}

//! --compare: the second run of either has its memory.
static Mat compareWithSGBM(HDPTreeMatcher& matcher, const Mat& left, const Mat& right)
{
    double sgbmTime;
    computeLikeSGBM(matcher, left, right, sgbmTime);
    const Mat sgbm = computeLikeSGBM(matcher, left, right, sgbmTime);
    TickMeter clock;
    clock.start();
    computeDisparity(matcher, left, right);
    clock.stop();
    std::cout << format("%-11s%-24s%10.1f ms\n%-11s%-24s%10.1f ms: %.1f times faster\n", "compared", "StereoSGBM, 3WAY",
                        sgbmTime, "", "HDPTreeMatcher", clock.getTimeMilli(), sgbmTime / clock.getTimeMilli());
    return sgbm;
}

void matchPair(const CommandLineParser& parser)
{
    checkOptions(parser);
    Rectifier rectifier(parser);
    Mat leftMask, rightMask, left = readPicture(parser.get<String>("@left"), leftMask),
                             right = readPicture(parser.get<String>("@right"), rightMask);
    makeAlike(left, right);
    if (parser.has("compare") && left.depth() != CV_8U)
        CV_Error(Error::StsUnsupportedFormat, "--compare needs images of 8 bit: cv::StereoSGBM takes no others");
    const Ptr<HDPTreeMatcher> matcher = createMatcher(parser, left.cols);
    if (!rectifier.apply(left, right, leftMask, rightMask, *matcher))
        MaskFiles(parser).apply(leftMask, rightMask, *matcher);
    const Matx44d Q = parser.has("point-cloud") ? readQ(parser, rectifier.rig(), left.size()) : Matx44d();
    const Mat truth = parser.has("truth") ? readTruth(parser.get<String>("truth"), left.size()) : Mat();
    const Mat disparity = computeDisparity(*matcher, left, right);

    printRange(*matcher);
    printTimes(*matcher);
    warnOfPair(*matcher);
    const Mat sgbm = parser.has("compare") ? compareWithSGBM(*matcher, left, right) : Mat();
    if (!truth.empty() && !sgbm.empty())
        printErrors("StereoSGBM, 3WAY", sgbm, truth);
    if (!truth.empty())
        printErrors("HDPTreeMatcher", disparity, truth);
    const String output = parser.get<String>(parser.has("output") ? "output" : "@out");
    if (!output.empty())
        writeAndTell(output, encodeDisparity(extensionOf(output), disparity));
    writeReliability(parser, *matcher);
    if (parser.has("save-findings"))
    {
        const String path = parser.get<String>("save-findings");
        writeFindings(path, matcher->getPairModel());
        std::cout << "written    " << path << std::endl;
    }
    if (parser.has("picture"))
        writePicture(parser.get<String>("picture"), left, sgbm, disparity);
    if (parser.has("depth"))
        writeDepth(parser.get<String>("depth"), *rectifier.rig(), disparity, matcher->getFindings().minDisparity);
    if (parser.has("point-cloud"))
    {
        const Mat known = disparity < std::numeric_limits<float>::infinity();
        writeAndTell(parser.get<String>("point-cloud"), pointCloud(disparity, known, colorsOf(left, known), Q));
    }
}
