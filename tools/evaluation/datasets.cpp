// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "datasets.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>

#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"

#include "command_line.hpp"

namespace hdp_tools {

namespace fs = cv::utils::fs;

static String fileName(const String& path) { return path.substr(path.find_last_of("/\\") + 1); }

//! The path of a file of this name and the extension of a picture; empty if there is none.
static String findPicture(const String& folder, const String& stem)
{
    for (const char* extension : { ".png", ".pfm", ".ppm", ".pgm", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff" })
    {
        const String path = fs::join(folder, stem + extension);
        if (fs::exists(path) && !fs::isDirectory(path))
            return path;
    }
    return String();
}

//! As findPicture(); a name for messages if there is none.
static String expectPicture(const String& folder, const String& stem)
{
    const String path = findPicture(folder, stem);
    return path.empty() ? fs::join(folder, stem + ".png") : path;
}

static std::vector<String> subfolders(const String& folder)
{
    std::vector<String> entries, folders;
    fs::glob(folder, String(), entries, false, true);
    std::copy_if(entries.begin(), entries.end(), std::back_inserter(folders),
                 [](const String& path) { return fs::isDirectory(path) && fileName(path)[0] != '.'; });
    std::sort(folders.begin(), folders.end());
    return folders;
}

//! Middlebury's resolution that the name of a folder stands for; empty if none.
static String resolutionOfName(const String& folderName)
{
    const String name = lowerCase(folderName);
    for (const char* resolution : { "full", "half", "third", "quarter" })
    {
        const String word = resolution;
        const String letter(1, word[0]); // of MiddEval3
        if (name == word || name == word + "size" || name == word + "_size" || name == "training" + letter ||
            name == "test" + letter)
            return word;
    }
    return String();
}

//! What Middlebury 2001 to 2006 divide the disparities of a resolution by.
static int resolutionDivisor(const String& resolution)
{
    return resolution == "quarter" ? 4 : resolution == "third" ? 3 : resolution == "half" ? 2 : 1;
}

//! Resolution of the 2005 and 2006 pairs by their height; empty for any other height.
static String resolutionOfHeight(int height)
{
    return height == 1110 ? "full" : height == 555 ? "half" : height == 370 ? "third" : "";
}

//! The scene of a folder that has a left or right image by the names of Middlebury. Its set is the path of a folder.
static bool readSceneFolder(const String& folder, Scene& scene)
{
    const struct
    {
        const char *left, *right, *truth, *rightTruth, *mask;
        bool needsCalibration;
    } layouts[] = {
        { "left", "right", "disp_left", "disp_right", "nonoccluded", false },
        { "view1", "view5", "disp1", "disp5", 0, false },
        { "im2", "im6", "disp2", "disp6", 0, false },
        { "im0", "im1", "disp0GT", "disp1GT", "mask0nocc", true },
        { "im0", "im1", "disp0", "disp1", "mask0nocc", true },
    };
    for (const auto& layout : layouts)
    {
        if (findPicture(folder, layout.left).empty() && findPicture(folder, layout.right).empty())
            continue;
        const auto knowsTruth = [&](const String& path) {
            return !findPicture(path, layout.truth).empty() || !findPicture(path, layout.rightTruth).empty();
        };
        scene.name = fileName(folder);
        String sceneFolder = folder; // with the truth
        const String parent = fs::getParent(folder), grandparent = fs::getParent(parent);
        if (layout.left == String("view1") && !knowsTruth(folder) && knowsTruth(grandparent))
        {
            sceneFolder = grandparent;
            scene.name = fileName(grandparent) + "_" + fileName(parent) + "_" + scene.name;
        }
        const bool hasTruth = knowsTruth(sceneFolder);
        if (layout.needsCalibration && !hasTruth && layout.truth == String("disp0GT"))
            continue; // 2014, or MiddEval3's test pairs, which are the same without truth
        scene.left = expectPicture(folder, layout.left);
        scene.right = expectPicture(folder, layout.right);
        if (hasTruth)
        {
            scene.truth = expectPicture(sceneFolder, layout.truth);
            scene.rightTruth = expectPicture(sceneFolder, layout.rightTruth);
        }
        if (layout.mask)
            scene.nonOccludedMask = findPicture(folder, layout.mask);
        const String calibration = fs::join(folder, "calib.txt");
        if (layout.needsCalibration || fs::exists(calibration))
            scene.calibration = calibration;
        scene.isFrame = false;

        scene.set = fs::getParent(sceneFolder);
        scene.resolution = resolutionOfName(fileName(scene.set));
        if (scene.resolution.empty())
            scene.resolution = resolutionOfName(fileName(fs::getParent(scene.set)));
        if (scene.resolution.empty() && hasTruth && scene.calibration.empty())
        {
            const Mat truth = cv::imread(scene.truth, cv::IMREAD_UNCHANGED);
            if (truth.depth() == CV_8U)
                scene.resolution = resolutionOfHeight(truth.rows);
        }
        return true;
    }
    return false;
}

//! Whether a picture is one of the others of a frame that KITTI knows the truth of at NUMBER_10.png: NUMBER_11.png is for
//! optical flow, and the multi-view sets have 00 to 20.
static bool isOtherTime(const String& file)
{
    const String time = "_10.png";
    if (file.size() < time.size())
        return false;
    const size_t end = file.size() - time.size();
    return file[end] == '_' && std::isdigit(uchar(file[end + 1])) && std::isdigit(uchar(file[end + 2])) &&
           file.substr(end) != time && fs::exists(file.substr(0, end) + time);
}

//! The frames of a folder that has KITTI's folders.
static std::vector<Scene> readFrameFolder(const String& folder)
{
    const char* const layouts[][4] = { { "image_2", "image_3", "disp_occ_0", "disp_noc_0" },
                                       { "colored_0", "colored_1", "disp_occ", "disp_noc" },
                                       { "image_0", "image_1", "disp_occ", "disp_noc" },
                                       { "left", "right", "disp_lidar", "" } };
    std::vector<Scene> scenes;
    for (const auto& layout : layouts)
    {
        const String left = fs::join(folder, layout[0]), truth = fs::join(folder, layout[2]),
                     nonOccluded = fs::join(folder, layout[3]);
        if (!fs::isDirectory(left) || !fs::isDirectory(fs::join(folder, layout[1])))
            continue;
        std::vector<String> files;
        fs::glob(left, "*.png", files);
        std::sort(files.begin(), files.end());
        for (const String& file : files)
        {
            const String name = fileName(file);
            if (isOtherTime(file))
                continue;
            Scene scene;
            scene.name = name.substr(0, name.size() - 4);
            scene.left = file;
            scene.right = fs::join(fs::join(folder, layout[1]), name);
            scene.truth = fs::isDirectory(truth) ? fs::join(truth, name) : String();
            scene.nonOccludedTruth =
                *layout[3] && fs::isDirectory(nonOccluded) ? fs::join(nonOccluded, name) : String();
            scene.isFrame = true;
            scenes.push_back(scene);
        }
        break;
    }
    return scenes;
}

//! Puts the scenes of a set one after the other, where folders of other sets come between them.
static void groupBySet(std::vector<Scene>& scenes)
{
    std::map<String, size_t> places;
    for (const Scene& scene : scenes)
        places.insert({ scene.set, places.size() });
    std::stable_sort(scenes.begin(), scenes.end(),
                     [&](const Scene& a, const Scene& b) { return places.at(a.set) < places.at(b.set); });
}

std::vector<Scene> findScenes(const String& root)
{
    if (!fs::isDirectory(root))
        fail("'" + root + "' is not a folder");
    const String top = fs::canonical(root);
    std::vector<Scene> scenes;

    struct Search
    {
        const String& top;
        std::vector<Scene>& scenes;

        //! "a/b" of the folder top/a/b; the top's own name for itself, and that of a scene's parent above it.
        String setName(const String& folder) const
        {
            return folder.size() > top.size() ? folder.substr(top.size() + 1) : fileName(folder);
        }

        void visit(const String& folder, int depth)
        {
            Scene scene;
            if (readSceneFolder(folder, scene))
            {
                scene.set = setName(scene.set);
                scenes.push_back(scene);
                return;
            }
            for (Scene& frame : readFrameFolder(folder))
            {
                frame.set = setName(folder);
                scenes.push_back(frame);
            }
            const int maxDepth = 6; // also ends loops of links
            for (const String& subfolder : depth < maxDepth ? subfolders(folder) : std::vector<String>())
                visit(subfolder, depth + 1);
        }
    } search = { top, scenes };
    search.visit(top, 0);
    if (scenes.empty())
        fail("no stereo pairs of a known kind in '" + root + "'");
    groupBySet(scenes);
    return scenes;
}

std::vector<Scene> selectScenes(const cv::CommandLineParser& parser)
{
    std::vector<Scene> scenes = findScenes(parser.get<String>("@root"));
    const auto listOf = [&](const char* option) {
        return parser.has(option) ? splitList(option, parser.get<String>(option)) : std::vector<String>();
    };
    const std::vector<String> resolutions = listOf("resolution"), names = listOf("scenes");
    for (const String& resolution : resolutions)
        if (resolution != "full" && resolution != "half" && resolution != "third" && resolution != "quarter")
            fail("--resolution: unknown resolution '" + resolution + "', there are: full, half, third, quarter");
    for (const String& name : names)
        if (std::none_of(scenes.begin(), scenes.end(), [&](const Scene& scene) { return scene.name == name; }))
            fail("--scenes: there is no scene '" + name + "'");
    const auto isLeftOut = [&](const Scene& scene) {
        const bool otherResolution =
            !resolutions.empty() && !scene.resolution.empty() &&
            std::find(resolutions.begin(), resolutions.end(), scene.resolution) == resolutions.end();
        return otherResolution || (!names.empty() && std::find(names.begin(), names.end(), scene.name) == names.end());
    };
    scenes.erase(std::remove_if(scenes.begin(), scenes.end(), isLeftOut), scenes.end());
    if (scenes.empty())
        fail("no pair is left by --resolution and --scenes");
    return scenes;
}

//! "ndisp" of Middlebury's calib.txt
static int readDisparityCount(const String& path)
{
    std::ifstream file(path.c_str());
    if (!file)
        fail("cannot read '" + path + "'");
    for (String line; std::getline(file, line);)
    {
        const String key = "ndisp=";
        if (line.compare(0, key.size(), key) != 0)
            continue;
        char* end = 0;
        const long count = std::strtol(line.c_str() + key.size(), &end, 10);
        const bool isNumber =
            end != line.c_str() + key.size() && String(end).find_first_not_of(" \t\r") == String::npos;
        if (!isNumber || count < 1 || count > 2048)
            fail("'" + path + "': not a number of disparities from 1 to 2048: " + line);
        return int(count);
    }
    fail("'" + path + "' has no line ndisp=");
    return 0;
}

//! Reads a picture that must have the size of the left image.
static void expectSize(const String& path, const Mat& image, cv::Size size)
{
    if (image.size() != size)
        fail(cv::format("'%s' is %d x %d, the left image is %d x %d", path.c_str(), image.cols, image.rows, size.width,
                        size.height));
}

static Mat readOfSize(const String& path, int flags, cv::Size size)
{
    const Mat image = readImage(path, flags);
    expectSize(path, image, size);
    return image;
}

//! A truth file of any kind. The resolution matters to 8-bit files only.
static Mat readTruth(const String& path, cv::Size size, const String& resolution, int& depth)
{
    const Mat image = readOfSize(path, cv::IMREAD_UNCHANGED, size);
    depth = image.depth();
    return toDisparity(image, path, depth == CV_8U ? resolutionDivisor(resolution) : 0);
}

//! Mask of the pixels of a pair with truth that count
static Mat readJudged(const Scene& scene, const Pair& pair)
{
    if (pair.protocol == Pair::KITTI)
        return knownPixels(pair.truth);
    if (!scene.nonOccludedMask.empty())
        return (readOfSize(scene.nonOccludedMask, cv::IMREAD_GRAYSCALE, pair.left.size()) == 255) &
               knownPixels(pair.truth);
    // The maps of 2001 to 2006 are whole numbers and agree exactly.
    const double tolerance = pair.protocol == Pair::BAD ? 1 : 0;
    return nonOccludedPixels(pair.truth, pair.rightTruth, tolerance);
}

static int numDisparitiesOf(const Scene& scene, const Pair& pair)
{
    const int ofEth3d = 64;
    const int width = pair.left.cols;
    if (!scene.calibration.empty())
    {
        // ETH3D gives the width, for it does not know the range.
        const int count = readDisparityCount(scene.calibration);
        return count == width ? ofEth3d : count;
    }
    if (pair.protocol == Pair::KITTI)
        return 256;
    return scene.resolution.empty() ? defaultNumDisparities(width) : 256 / resolutionDivisor(scene.resolution);
}

Pair readPair(const Scene& scene)
{
    Pair pair;
    pair.protocol = Pair::NO_TRUTH;
    pair.left = readPicture(scene.left);
    pair.right = readPicture(scene.right);
    const cv::Size size = pair.left.size();
    expectSize(scene.right, pair.right, size);
    if (!scene.truth.empty())
    {
        int depth = 0;
        pair.truth = readTruth(scene.truth, size, scene.resolution, depth);
        const bool isKitti = scene.isFrame || (depth == CV_16U && !fs::exists(scene.rightTruth));
        pair.protocol = isKitti ? Pair::KITTI : depth == CV_32F ? Pair::BAD : Pair::MIDDLEBURY;
        if (depth == CV_8U) // whole pixels of the full size
            pair.truthDeviation = std::sqrt(1 / 12.) / resolutionDivisor(scene.resolution);
        // Without a mask, it says what is not occluded; it must be there.
        if (!isKitti && (scene.nonOccludedMask.empty() || fs::exists(scene.rightTruth)))
            pair.rightTruth = readTruth(scene.rightTruth, size, scene.resolution, depth);
        pair.judged = readJudged(scene, pair);
        if (isKitti && !scene.nonOccludedTruth.empty())
            pair.judgedNonOccluded = knownPixels(readTruth(scene.nonOccludedTruth, size, String(), depth));
        if (cv::countNonZero(pair.judged) == 0)
            fail("'" + scene.truth + "' knows no pixel that can be judged");
    }
    pair.disparities = cv::Range(0, numDisparitiesOf(scene, pair));
    return pair;
}

void expectProtocol(const Pair& pair, Pair::Protocol protocol)
{
    if (pair.protocol != protocol)
        fail("its truth is of another kind than that of its set's pairs before it");
}

} // namespace hdp_tools
