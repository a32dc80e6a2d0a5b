// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Pairs as less than ideal cameras would have taken them: the truth stays valid.

#ifndef OPENCV_HDPSTEREO_TOOLS_BAD_CAMERAS_HPP
#define OPENCV_HDPSTEREO_TOOLS_BAD_CAMERAS_HPP

#include <functional>
#include <vector>

#include "opencv2/core.hpp"

namespace hdp_tools {

using cv::Mat;
using cv::String;

//! A change of one image, CV_8UC3. rng: for noise.
typedef std::function<Mat(const Mat& image, cv::RNG& rng)> ImageChange;

//! The levels are changed by a function of them, from 0 to 255.
ImageChange changeLevels(const std::function<double(double)>& change);

//! Gaussian noise of this standard deviation is added, in levels.
ImageChange addNoise(double deviation);

//! The same, in levels of 255, of an image of 8 or 16 bit and any number of channels
Mat addNoise(const Mat& image, double deviation, cv::RNG& rng);

//! JPEG of this quality
ImageChange compress(int quality);

struct CameraCase
{
    String name; // for --cases, and in the table
    ImageChange left, right;
    std::function<Mat(cv::Size)> shownLeft, shownRight; // masks of what is not blank then; none: nothing is
};

/** The cases of a list of names that is separated by commas, in this order; each once. A name with a number takes any
other number, too.

- clean: the pair as it is
- gain.7, gain.5: the right image times this; gamma1.5: its gamma; offset30: added to it
- vignette: the right image, by 1 - 0.35 r^2, r being 1 at the middles of the borders
- noise2, noise5, noise15: Gaussian noise of this standard deviation in both images
- defects.5: so many percent of the pixels of both images are black or white
- dark: an eighth of the light, and noise of standard deviation 2, in both; linear: gamma 2.2 in both, as of raw images
- blur1.5: the right image by a Gaussian of this standard deviation in pixels; jpeg30: both images by this quality
- dy.5, dy1, dy2, dy-3: the right image so many rows lower
- borders6: wedges on all sides are black, up to so many percent of the image wide, other ones in each image, as
  rectification leaves them
- shear: the right image's rows, by 0.3 degrees; stretch: moved by 0.7 rows, and by 3 and 4 thousandths of x and y

@param option The name of the option, for messages.
*/
std::vector<CameraCase> selectCases(const String& option, const String& list);

//! The names of all cases above
extern const char* const ALL_CASES;

} // namespace hdp_tools

#endif
