// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches a rectified stereo pair with cv::stereo::HDPTreeMatcher, and writes the disparities, a picture of them and a
// point cloud.

#include <fstream>
#include <iostream>
#include <map>

#include "opencv2/core/utils/logger.hpp"
#include "opencv2/hdpstereo.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

using namespace cv;
using cv::stereo::HDPTreeMatcher;

static const char* const keys =
    "{help h ?        |      | print this and exit }"
    "{@left           |      | left image of a rectified pair, of 8 or 16 bit }"
    "{@right          |      | right image }"
    "{preset          | fast | set of parameters: ultrafast, fast, quality, tree or paper }"
    "{min-disparity   | 0    | smallest disparity in pixels }"
    "{num-disparities |      | number of disparities; by default width / 5, rounded up to a multiple of 16 }"
    "{output          |      | disparities: FILE.png (16 bit, times 256, 0 = none) or FILE.pfm (float, inf = none) }"
    "{picture         |      | disparities in colors: far is blue, near is orange, none is black }"
    "{truth           |      | true disparities: PNG, 8 bit or 16 bit (times 256), 0 = unknown }"
    "{point-cloud     |      | colored points: FILE.ply; needs --focal and --baseline }"
    "{focal           | 0    | focal length in pixels; the principal point is the center of the image }"
    "{baseline        | 0    | distance of the cameras, in the unit of the points }";

//! Unlike imwrite(), this notices a full disk.
static void writeFile(const String& path, const std::vector<uchar>& bytes)
{
    std::ofstream file(path.c_str(), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    if (!file.flush())
        CV_Error(Error::StsError, "cannot write '" + path + "'");
    std::cout << "written    " << path << std::endl;
}

static void writeImage(const String& path, const Mat& image)
{
    std::vector<uchar> bytes;
    imencode(path.substr(std::min(path.rfind('.'), path.size())), image, bytes);
    writeFile(path, bytes);
}

static Mat readImage(const String& path, int flags)
{
    const Mat image = imread(path, flags);
    if (image.empty())
        CV_Error(Error::StsError, "cannot read the image '" + path + "'");
    return image;
}

//! Colours in 8 bit, or grey levels in 16 bit of a picture that has them
static Mat readPicture(const String& path)
{
    Mat image = readImage(path, IMREAD_COLOR | IMREAD_ANYDEPTH);
    if (image.depth() == CV_16U)
        cvtColor(image, image, COLOR_BGR2GRAY);
    return image;
}

//! For points: in 8 bit, from black to the brightest pixel
static Mat colorsOf(const Mat& image)
{
    if (image.type() == CV_8UC3)
        return image;
    Mat colors;
    normalize(image, colors, 0, 255, NORM_MINMAX, CV_8U);
    cvtColor(colors, colors, COLOR_GRAY2BGR);
    return colors;
}

static Ptr<HDPTreeMatcher> createMatcher(const CommandLineParser& parser, int width)
{
    const std::map<String, int> presets = { { "ultrafast", HDPTreeMatcher::PRESET_ULTRAFAST },
                                            { "fast", HDPTreeMatcher::PRESET_FAST },
                                            { "quality", HDPTreeMatcher::PRESET_QUALITY },
                                            { "tree", HDPTreeMatcher::PRESET_TREE },
                                            { "paper", HDPTreeMatcher::PRESET_PAPER } };
    const auto preset = presets.find(parser.get<String>("preset"));
    if (preset == presets.end())
        CV_Error(Error::StsBadArg, "--preset=" + parser.get<String>("preset") + " is unknown, see --help");
    const int minDisparity = parser.get<int>("min-disparity");
    int numDisparities = std::max((width / 5 + 15) / 16 * 16, 16);
    if (parser.has("num-disparities"))
        numDisparities = parser.get<int>("num-disparities");
    return HDPTreeMatcher::create(minDisparity, numDisparities, preset->second);
}

static void printTimes(const HDPTreeMatcher& matcher)
{
    std::vector<String> stages;
    std::vector<double> milliseconds;
    matcher.getStageTimes(stages, milliseconds);
    for (size_t i = 0; i < stages.size(); i++)
        std::cout << format("%-11s%-24s%10.1f ms\n", i == 0 ? "time" : "", stages[i].c_str(), milliseconds[i]);
}

//! Pixels without a disparity are wrong.
static void printErrors(const Mat& disparity, const Mat& truth)
{
    CV_CheckEQ(truth.size(), disparity.size(), "--truth must have the size of the images");
    Mat error;
    truth.convertTo(error, CV_32F, truth.depth() == CV_16U ? 1. / 256 : 1);
    error = abs(disparity - error);
    for (int threshold = 1; threshold <= 2; threshold++)
        std::cout << format("%-11serr>=%-19d%10.2f %%\n", threshold == 1 ? "wrong" : "", threshold,
                            100. * countNonZero((error >= threshold) & (truth != 0)) / countNonZero(truth));
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
    const Mat finite = known & (disparity != 0);
    const String header = format("ply\nformat binary_little_endian 1.0\nelement vertex %d\n"
                                 "property float x\nproperty float y\nproperty float z\n"
                                 "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
                                 countNonZero(finite));
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

static void run(const CommandLineParser& parser)
{
    const double f = parser.get<double>("focal"), B = parser.get<double>("baseline");
    if (parser.has("point-cloud") && !(f > 0 && B > 0))
        CV_Error(Error::StsBadArg, "--point-cloud needs --focal and --baseline, each above 0");
    const Mat left = readPicture(parser.get<String>("@left")), right = readPicture(parser.get<String>("@right"));
    const Ptr<HDPTreeMatcher> matcher = createMatcher(parser, left.cols);
    if (!parser.check())
        CV_Error(Error::StsBadArg, "an option needs a number, see --help");

    Mat disparity16, disparity; // in 1/16 pixel; in pixels
    matcher->compute(left, right, disparity16);
    disparity16.convertTo(disparity, CV_32F, 1. / StereoMatcher::DISP_SCALE);
    const Mat known = disparity >= matcher->getMinDisparity();
    disparity.setTo(std::numeric_limits<float>::infinity(), ~known);

    printTimes(*matcher);
    if (parser.has("truth"))
        printErrors(disparity, readImage(parser.get<String>("truth"), IMREAD_GRAYSCALE | IMREAD_ANYDEPTH));
    const String output = parser.get<String>("output");
    if (output.size() > 4 && output.substr(output.size() - 4) == ".png")
    {
        Mat disparity256;
        disparity.convertTo(disparity256, CV_16U, 256);
        disparity256.setTo(1, disparity256 == 0); // 0 stands for none
        disparity256.setTo(0, (disparity < 0) | (disparity >= 256));
        writeImage(output, disparity256);
    }
    else if (!output.empty())
        writeImage(output, disparity);
    if (parser.has("picture"))
        writeImage(parser.get<String>("picture"), colorPicture(disparity, known));
    if (parser.has("point-cloud"))
    {
        const Matx44d Q(1, 0, 0, -0.5 * (left.cols - 1), 0, 1, 0, -0.5 * (left.rows - 1), 0, 0, 0, f, 0, 0, 1 / B, 0);
        writeFile(parser.get<String>("point-cloud"), pointCloud(disparity, known, colorsOf(left), Q));
    }
    if (!std::cout.flush())
        CV_Error(Error::StsError, "cannot write to the standard output");
}

int main(int argc, char** argv)
{
    utils::logging::setLogLevel(utils::logging::LOG_LEVEL_SILENT); // errors are reported below
    CommandLineParser parser(argc, argv, keys);
    parser.about("Disparities of a rectified stereo pair.");
    try
    {
        for (const String& argument : std::vector<String>(argv + 1, argv + argc))
            if (argument.compare(0, 2, "--") == 0)
                parser.has(argument.substr(2, argument.find('=') - 2)); // throws if it is unknown
        if (parser.has("help"))
            parser.printMessage();
        else
            run(parser);
    }
    catch (const cv::Exception& e)
    {
        std::cerr << "error: " << e.err << std::endl;
        return 1;
    }
    return 0;
}
