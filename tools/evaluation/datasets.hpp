// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The scenes of datasets. findScenes() recognises those below a folder by the names of the files:
//
// - Middlebury 2005 and 2006 as published (SCENE/view1, view5, disp1, disp5; of the sets of 7 views, the images are in
//   SCENE/Illum1/Exp0 and so on) or with plain names (SCENE/left, right, disp_left, disp_right), 2003 (im2, im6, disp2,
//   disp6), 2014 (im0, im1, disp0, disp1, calib.txt) and MiddEval3 (im0, im1, disp0GT, disp1GT or mask0nocc, calib.txt),
//   or other pairs in one of these layouts, such as those of SceneFlow in MiddEval3's;
// - MiddEval3 and ETH3D with plain names: left, right, disp_left in PFM, nonoccluded, calib.txt;
// - KITTI 2015 (image_2, image_3, disp_occ_0, disp_noc_0: a folder each, with a file for every frame), 2012
//   (colored_0, colored_1 or image_0, image_1, disp_occ, disp_noc) and videos (left, right, disp_lidar), or a folder
//   for every frame with left, right and disp_left in 16 bit;
// - pairs without truth: SCENE/left, right.

#ifndef OPENCV_HDPSTEREO_TOOLS_DATASETS_HPP
#define OPENCV_HDPSTEREO_TOOLS_DATASETS_HPP

#include <vector>

#include "pair.hpp"

namespace hdp_tools {

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

    String title() const { return set + "/" + name; }
};

//! All scenes of a folder and the folders below it, by set and name. Fails if there is none.
std::vector<Scene> findScenes(const String& root);

//! Those of @root that --resolution and --scenes select. Fails if there is none.
std::vector<Scene> selectScenes(const cv::CommandLineParser& parser);

//! Reads a pair; what is wrong with it is an exception that names the file.
Pair readPair(const Scene& scene);

//! Fails if the truth of a pair is not of this kind: figures of different kinds have no mean.
void expectProtocol(const Pair& pair, Pair::Protocol protocol);

} // namespace hdp_tools

#endif
