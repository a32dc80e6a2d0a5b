// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches a rectified stereo pair with cv::stereo::HDPTreeMatcher, and writes the disparities, a picture of them and a
// point cloud; or matches many pairs, and writes the disparities of each.

#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#ifdef __unix__
#include <unistd.h>
#endif

#include "opencv2/core.hpp"
#include "opencv2/core/utils/filesystem.hpp"
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
    "{@out            |      | disparities, as --output; with --batch a folder }"
    "{batch           |      | --batch LEFTS RIGHTS OUT: matches files of the same name in two folders, or --batch "
    "LIST OUT: "
    "a line 'LEFT RIGHT NAME' per pair (between tabs if paths have spaces); writes OUT/NAME.png, keeps what is there, "
    "leaves out bad pairs (exit status 2) }"
    "{format          | png  | png or pfm: what --batch writes, see --output }"
    "{preset          | fast | set of parameters: ultrafast, fast, quality, tree or paper }"
    "{min-disparity   | 0    | smallest disparity in pixels }"
    "{num-disparities |      | number of disparities; by default width / 5, rounded up to a multiple of 16 }"
    "{output          |      | disparities: FILE.png (16 bit, times 256, 0 = none) or FILE.pfm (float, inf = none) }"
    "{picture         |      | disparities in colors: far is blue, near is orange, none is black }"
    "{truth           |      | true disparities: PNG, 8 bit or 16 bit (times 256), 0 = unknown }"
    "{point-cloud     |      | colored points: FILE.ply; needs --focal and --baseline }"
    "{focal           | 0    | focal length in pixels; the principal point is the center of the image }"
    "{baseline        | 0    | distance of the cameras, in the unit of the points }";

static String extensionOf(const String& path) { return path.substr(std::min(path.rfind('.'), path.size())); }

static std::vector<uchar> encode(const String& extension, const Mat& image)
{
    std::vector<uchar> bytes;
    imencode(extension, image, bytes);
    return bytes;
}

//! Unlike imwrite(), this notices a full disk.
static void writeFile(const String& path, const std::vector<uchar>& bytes)
{
    std::ofstream file(path.c_str(), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    file.close();
    if (!file)
        CV_Error(Error::StsError, "cannot write '" + path + "'");
}

//! Whole or not at all, whatever becomes of this program meanwhile
static void writeWholeFile(const String& path, const std::vector<uchar>& bytes)
{
    const String part = path + ".part";
    writeFile(part, bytes);
    if (std::rename(part.c_str(), path.c_str()) != 0)
        CV_Error(Error::StsError, "cannot write '" + path + "'");
}

static void writeAndTell(const String& path, const std::vector<uchar>& bytes)
{
    writeFile(path, bytes);
    std::cout << "written    " << path << std::endl;
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

static int numDisparitiesOf(const CommandLineParser& parser, int width)
{
    return parser.has("num-disparities") ? parser.get<int>("num-disparities")
                                         : std::max((width / 5 + 15) / 16 * 16, 16);
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
    const int minDisparity = parser.get<int>("min-disparity"), numDisparities = numDisparitiesOf(parser, width);
    if (!parser.check())
        CV_Error(Error::StsBadArg, "an option needs a number, see --help");
    return HDPTreeMatcher::create(minDisparity, numDisparities, preset->second);
}

//! In pixels, infinite where there is none
static Mat computeDisparity(HDPTreeMatcher& matcher, const Mat& left, const Mat& right)
{
    Mat disparity16, disparity;
    matcher.compute(left, right, disparity16);
    disparity16.convertTo(disparity, CV_32F, 1. / StereoMatcher::DISP_SCALE);
    disparity.setTo(std::numeric_limits<float>::infinity(), disparity < matcher.getMinDisparity());
    return disparity;
}

//! As --output says
static std::vector<uchar> encodeDisparity(const String& extension, const Mat& disparity)
{
    if (extension != ".png")
        return encode(extension, disparity);
    Mat disparity256;
    disparity.convertTo(disparity256, CV_16U, 256);
    disparity256.setTo(1, disparity256 == 0); // 0 stands for none
    disparity256.setTo(0, (disparity < 0) | (disparity >= 256));
    return encode(extension, disparity256);
}

static void printTimes(const HDPTreeMatcher& matcher)
{
    const HDPTreeMatcher::Findings findings = matcher.getFindings();
    for (size_t i = 0; i < findings.stages.size(); i++)
        std::cout << format("%-11s%-24s%10.1f ms\n", i == 0 ? "time" : "", findings.stages[i].c_str(),
                            findings.stageTimes[i]);
}

//! Of all pixels with known truth, also the occluded ones. Pixels without a disparity are wrong.
static void printErrors(const Mat& disparity, const Mat& truth)
{
    CV_CheckEQ(truth.size(), disparity.size(), "--truth must have the size of the images");
    Mat error;
    truth.convertTo(error, CV_32F, truth.depth() == CV_16U ? 1. / 256 : 1);
    error = abs(disparity - error);
    for (int threshold = 1; threshold <= 2; threshold++)
        std::cout << format("%-11serr>=%-19d%10.2f %%\n", threshold == 1 ? "wrong" : "", threshold,
                            100. * countNonZero((error >= threshold) & (truth != 0)) / countNonZero(truth));
    std::cout << "           of all pixels with known truth, those included that the right image does not show\n";
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

static void matchPair(const CommandLineParser& parser)
{
    const double f = parser.get<double>("focal"), B = parser.get<double>("baseline");
    if (parser.has("point-cloud") && !(f > 0 && B > 0))
        CV_Error(Error::StsBadArg, "--point-cloud needs --focal and --baseline, each above 0");
    if (!parser.has("@left") || !parser.has("@right"))
        CV_Error(Error::StsBadArg, "two images are needed, LEFT and RIGHT; --help says more");
    if (parser.has("output") && parser.has("@out"))
        CV_Error(Error::StsBadArg, "disparities go to one file: OUT or --output, not both");
    const Mat left = readPicture(parser.get<String>("@left")), right = readPicture(parser.get<String>("@right"));
    const Ptr<HDPTreeMatcher> matcher = createMatcher(parser, left.cols);
    const Mat disparity = computeDisparity(*matcher, left, right);
    const Mat known = disparity < std::numeric_limits<float>::infinity();

    printTimes(*matcher);
    if (parser.has("truth"))
        printErrors(disparity, readImage(parser.get<String>("truth"), IMREAD_GRAYSCALE | IMREAD_ANYDEPTH));
    const String output = parser.get<String>(parser.has("output") ? "output" : "@out");
    if (!output.empty())
        writeAndTell(output, encodeDisparity(extensionOf(output), disparity));
    if (parser.has("picture"))
    {
        const String picture = parser.get<String>("picture");
        writeAndTell(picture, encode(extensionOf(picture), colorPicture(disparity, known)));
    }
    if (parser.has("point-cloud"))
    {
        const Matx44d Q(1, 0, 0, -0.5 * (left.cols - 1), 0, 1, 0, -0.5 * (left.rows - 1), 0, 0, 0, f, 0, 0, 1 / B, 0);
        writeAndTell(parser.get<String>("point-cloud"), pointCloud(disparity, known, colorsOf(left), Q));
    }
}

struct NamedPair
{
    String left, right, name;
};

static String fileName(const String& path) { return path.substr(path.find_last_of("/\\") + 1); }

static String withoutExtension(const String& name) { return name.substr(0, name.rfind('.')); }

static std::vector<NamedPair> pairsOfFolders(const String& lefts, const String& rights)
{
    std::vector<String> paths;
    glob(utils::fs::join(lefts, "*"), paths);
    std::vector<NamedPair> pairs;
    for (const String& path : paths)
        if (haveImageWriter(path)) // by its extension
            pairs.push_back({ path, utils::fs::join(rights, fileName(path)), withoutExtension(fileName(path)) });
    return pairs;
}

static std::vector<NamedPair> pairsOfList(const String& list)
{
    std::ifstream file(list.c_str());
    if (!file)
        CV_Error(Error::StsError, "cannot read '" + list + "'");
    std::vector<NamedPair> pairs;
    for (std::string line; std::getline(file, line);)
    {
        std::istringstream words(line);
        std::vector<String> parts;
        const char delimiter = line.find('\t') != std::string::npos ? '\t' : ' ';
        for (std::string word; std::getline(words, word, delimiter);)
            if (word.find_first_not_of(" \r") != std::string::npos)
                parts.push_back(word.substr(0, word.find('\r')));
        if (parts.empty())
            continue;
        if (parts.size() != 3)
            CV_Error(Error::StsBadArg, "'" + list + "': not a left image, a right one and a name: " + line);
        pairs.push_back({ parts[0], parts[1], parts[2] });
    }
    return pairs;
}

//! One line on a terminal, which the next one replaces
static void printProgress(size_t done, size_t total, const String& name)
{
#ifdef __unix__
    static const bool isTerminal = isatty(STDERR_FILENO) != 0;
#else
    static const bool isTerminal = false;
#endif
    std::cerr << (isTerminal ? "\r\x1b[K" : "") << done << "/" << total << " " << name;
    if (isTerminal && done < total)
        std::cerr << std::flush;
    else
        std::cerr << std::endl;
}

//! @return How many pairs are bad.
static size_t matchPairs(const CommandLineParser& parser)
{
    for (const char* option : { "output", "picture", "truth", "point-cloud" })
        if (parser.has(option))
            CV_Error(Error::StsBadArg, format("--%s is for one pair, and not for --batch", option));
    const String format = parser.get<String>("format"), lefts = parser.get<String>("@left");
    if (format != "png" && format != "pfm")
        CV_Error(Error::StsBadArg, "--format=" + format + " is unknown, see --help");
    const bool areFolders = utils::fs::isDirectory(lefts);
    const String out = parser.get<String>(areFolders ? "@out" : "@right");
    if (out.empty() || (!areFolders && parser.has("@out")))
        CV_Error(Error::StsBadArg, "--batch needs LEFTS RIGHTS OUT, three folders, or LIST OUT, a file and a folder");
    const std::vector<NamedPair> pairs =
        areFolders ? pairsOfFolders(lefts, parser.get<String>("@right")) : pairsOfList(lefts);
    if (pairs.empty())
        CV_Error(Error::StsBadArg, "there is no pair in '" + lefts + "'");
    std::set<String> names;
    for (const NamedPair& pair : pairs)
        if (!names.insert(pair.name).second)
            CV_Error(Error::StsBadArg, "two pairs have the name '" + pair.name + "'");

    // One for all pairs: it keeps its memory.
    const Ptr<HDPTreeMatcher> matcher = createMatcher(parser, 0);
    size_t done = 0, old = 0, bad = 0;
    for (const NamedPair& pair : pairs)
    {
        const String path = utils::fs::join(out, pair.name + "." + format);
        done++;
        if (utils::fs::exists(path))
        {
            old++;
            continue;
        }
        std::vector<uchar> bytes;
        try
        {
            const Mat left = readPicture(pair.left), right = readPicture(pair.right);
            matcher->setNumDisparities(numDisparitiesOf(parser, left.cols));
            bytes = encodeDisparity("." + format, computeDisparity(*matcher, left, right));
        }
        catch (const cv::Exception& e)
        {
            bad++;
            printProgress(done, pairs.size(), pair.name + " left out: " + e.err + "\n");
            continue;
        }
        utils::fs::createDirectories(utils::fs::getParent(path));
        writeWholeFile(path, bytes);
        printProgress(done, pairs.size(), pair.name);
    }
    std::cout << pairs.size() - old - bad << " pairs matched, " << old << " were there, " << bad << " left out"
              << std::endl;
    return bad;
}

int main(int argc, char** argv)
{
    utils::logging::setLogLevel(utils::logging::LOG_LEVEL_SILENT); // errors are reported below
    CommandLineParser parser(argc, argv, keys);
    parser.about("Disparities of a rectified stereo pair, or of many.");
    int status = 0;
    try
    {
        for (const String& argument : std::vector<String>(argv + 1, argv + argc))
            if (argument.compare(0, 2, "--") == 0)
                parser.has(argument.substr(2, argument.find('=') - 2)); // throws if it is unknown
        if (parser.has("help"))
            parser.printMessage();
        else if (parser.has("batch"))
            status = matchPairs(parser) == 0 ? 0 : 2;
        else
            matchPair(parser);
        if (!std::cout.flush())
            CV_Error(Error::StsError, "cannot write to the standard output");
    }
    catch (const cv::Exception& e)
    {
        std::cerr << "error: " << e.err << std::endl;
        return 1;
    }
    return status;
}
