// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What the samples share to read datasets. findScenes() recognises the scenes below a folder by the names of the files:
//
// - Middlebury 2005 and 2006 as published (SCENE/view1, view5, disp1, disp5; of the sets of 7 views, the images are in
//   SCENE/Illum1/Exp0 and so on) or with plain names (SCENE/left, right, disp_left, disp_right), 2003 (im2, im6, disp2,
//   disp6), 2014 (im0, im1, disp0, disp1, calib.txt) and MiddEval3 (im0, im1, disp0GT, disp1GT or mask0nocc, calib.txt);
// - KITTI 2015 (image_2, image_3, disp_occ_0, disp_noc_0: a folder each, with a file for every frame) and 2012
//   (colored_0, colored_1 or image_0, image_1, disp_occ, disp_noc), or a folder for every frame with left, right and
//   disp_left in 16 bit;
// - pairs without truth: SCENE/left, right.
//
// readPair() reads one of them; what is wrong with it is an exception that names the file.

#ifndef OPENCV_HDPSTEREO_SAMPLES_DATASETS_HPP
#define OPENCV_HDPSTEREO_SAMPLES_DATASETS_HPP

#include "hdp_samples_common.hpp"

#include "opencv2/core/utils/filesystem.hpp"

namespace hdp_samples {

//! The files of a pair, whether they exist or not
struct Scene
{
    String set;        // the folder of the scene, below the root's: "middlebury2006/full"
    String name;       // "Aloe"
    String resolution; // of Middlebury's images: "full", "half", "third", "quarter", or empty
    String left, right;
    String truth, rightTruth; // empty if the pair has none
    String nonOccludedMask;   // 255 where the right image shows the pixel, or empty
    String nonOccludedTruth;  // KITTI's truth without the pixels that the right image does not show, or empty
    String calibration;       // Middlebury's calib.txt with the number of disparities, or empty
    bool isFrame;             // of KITTI
};

//! A pair and what is known of it
struct Pair
{
    enum Protocol
    {
        NO_TRUTH,
        MIDDLEBURY, // err>=1 and err>=2 of the non-occluded pixels
        KITTI       // D1: errors above 3 pixels and 5 %, of all known pixels and of the non-occluded ones
    };
    Protocol protocol;
    Mat left, right;       // CV_8UC3
    int numDisparities;    // disparities 0 .. numDisparities - 1 are to be searched
    Mat truth;             // NO_DISPARITY where unknown; empty without truth
    Mat judged;            // mask of the pixels that count
    Mat judgedNonOccluded; // those of KITTI that are not occluded; may be empty
};

namespace fs = cv::utils::fs;

inline String fileName(const String& path) { return path.substr(path.find_last_of("/\\") + 1); }

//! The path of a file of this name and the extension of a picture; empty if there is none.
inline String findPicture(const String& folder, const String& stem)
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
inline String expectPicture(const String& folder, const String& stem)
{
    const String path = findPicture(folder, stem);
    return path.empty() ? fs::join(folder, stem + ".png") : path;
}

inline std::vector<String> subfolders(const String& folder)
{
    std::vector<String> entries, folders;
    fs::glob(folder, String(), entries, false, true);
    std::copy_if(entries.begin(), entries.end(), std::back_inserter(folders),
                 [](const String& path) { return fs::isDirectory(path) && fileName(path)[0] != '.'; });
    std::sort(folders.begin(), folders.end());
    return folders;
}

//! Middlebury's resolution that the name of a folder stands for; empty if none.
inline String resolutionOfName(const String& folderName)
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
inline int resolutionDivisor(const String& resolution)
{
    return resolution == "quarter" ? 4 : resolution == "third" ? 3 : resolution == "half" ? 2 : 1;
}

//! Resolution of the 2005 and 2006 pairs by their height; empty for any other height.
inline String resolutionOfHeight(int height)
{
    return height == 1110 ? "full" : height == 555 ? "half" : height == 370 ? "third" : "";
}

//! The scene of a folder that has a left or right image by the names of Middlebury. Its set is the path of a folder.
inline bool readSceneFolder(const String& folder, Scene& scene)
{
    const struct
    {
        const char *left, *right, *truth, *rightTruth, *mask, *calibration;
    } layouts[] = {
        { "left", "right", "disp_left", "disp_right", 0, 0 },
        { "view1", "view5", "disp1", "disp5", 0, 0 },
        { "im2", "im6", "disp2", "disp6", 0, 0 },
        { "im0", "im1", "disp0GT", "disp1GT", "mask0nocc", "calib.txt" },
        { "im0", "im1", "disp0", "disp1", "mask0nocc", "calib.txt" },
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
        if (layout.calibration && !hasTruth && layout.truth == String("disp0GT"))
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
        if (layout.calibration)
            scene.calibration = fs::join(folder, layout.calibration);
        scene.isFrame = false;

        scene.set = fs::getParent(sceneFolder);
        scene.resolution = resolutionOfName(fileName(scene.set));
        if (scene.resolution.empty())
            scene.resolution = resolutionOfName(fileName(fs::getParent(scene.set)));
        if (scene.resolution.empty() && hasTruth && !layout.calibration)
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
inline bool isOtherTime(const String& file)
{
    const String time = "_10.png";
    if (file.size() < time.size())
        return false;
    const size_t end = file.size() - time.size();
    return file[end] == '_' && std::isdigit(uchar(file[end + 1])) && std::isdigit(uchar(file[end + 2])) &&
           file.substr(end) != time && fs::exists(file.substr(0, end) + time);
}

//! The frames of a folder that has KITTI's folders.
inline std::vector<Scene> readFrameFolder(const String& folder)
{
    const char* const layouts[][4] = { { "image_2", "image_3", "disp_occ_0", "disp_noc_0" },
                                       { "colored_0", "colored_1", "disp_occ", "disp_noc" },
                                       { "image_0", "image_1", "disp_occ", "disp_noc" } };
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
            scene.nonOccludedTruth = fs::isDirectory(nonOccluded) ? fs::join(nonOccluded, name) : String();
            scene.isFrame = true;
            scenes.push_back(scene);
        }
        break;
    }
    return scenes;
}

//! All scenes of a folder and the folders below it, by set and name. Fails if there is none.
inline std::vector<Scene> findScenes(const String& root)
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
    return scenes;
}

//! "ndisp" of Middlebury's calib.txt
inline int readDisparityCount(const String& path)
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
inline Mat readOfSize(const String& path, int flags, cv::Size size)
{
    const Mat image = readImage(path, flags);
    if (image.size() != size)
        fail(cv::format("'%s' is %d x %d, the left image is %d x %d", path.c_str(), image.cols, image.rows, size.width,
                        size.height));
    return image;
}

//! A truth file of any kind. The resolution matters to 8-bit files only.
inline Mat readTruth(const String& path, cv::Size size, const String& resolution, bool& is16Bit)
{
    const Mat image = readOfSize(path, cv::IMREAD_UNCHANGED, size);
    is16Bit = image.depth() == CV_16U;
    return toDisparity(image, path, image.depth() == CV_8U ? resolutionDivisor(resolution) : 0);
}

inline Pair readPair(const Scene& scene)
{
    Pair pair;
    pair.left = readImage(scene.left, cv::IMREAD_COLOR);
    const cv::Size size = pair.left.size();
    pair.right = readOfSize(scene.right, cv::IMREAD_COLOR, size);
    pair.protocol = Pair::NO_TRUTH;
    bool is16Bit = false;
    if (!scene.truth.empty())
    {
        pair.truth = readTruth(scene.truth, size, scene.resolution, is16Bit);
        const bool isKitti = scene.isFrame || (is16Bit && !fs::exists(scene.rightTruth));
        pair.protocol = isKitti ? Pair::KITTI : Pair::MIDDLEBURY;
    }
    if (pair.protocol == Pair::KITTI)
    {
        pair.judged = knownPixels(pair.truth);
        if (!scene.nonOccludedTruth.empty())
            pair.judgedNonOccluded = knownPixels(readTruth(scene.nonOccludedTruth, size, String(), is16Bit));
    }
    else if (pair.protocol == Pair::MIDDLEBURY && !scene.nonOccludedMask.empty())
        pair.judged = (readOfSize(scene.nonOccludedMask, cv::IMREAD_GRAYSCALE, size) == 255) & knownPixels(pair.truth);
    else if (pair.protocol == Pair::MIDDLEBURY)
    {
        // The maps of 2001 to 2006 are whole numbers and agree exactly.
        const double tolerance = scene.calibration.empty() ? 0 : 1;
        const Mat rightTruth = readTruth(scene.rightTruth, size, scene.resolution, is16Bit);
        pair.judged = nonOccludedPixels(pair.truth, rightTruth, tolerance);
    }
    if (pair.protocol != Pair::NO_TRUTH && cv::countNonZero(pair.judged) == 0)
        fail("'" + scene.truth + "' knows no pixel that can be judged");

    if (!scene.calibration.empty())
        pair.numDisparities = readDisparityCount(scene.calibration);
    else if (pair.protocol == Pair::KITTI)
        pair.numDisparities = 256;
    else if (!scene.resolution.empty())
        pair.numDisparities = 256 / resolutionDivisor(scene.resolution);
    else
        pair.numDisparities = defaultNumDisparities(size.width);
    return pair;
}

} // namespace hdp_samples

#endif
