// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_CALIBRATION_TEXT_HPP
#define OPENCV_HDPSTEREO_CALIBRATION_TEXT_HPP

#include "opencv2/hdpstereo/stereo_rig.hpp"

#include <map>
#include <string>
#include <vector>

namespace cv { namespace stereo { namespace hdp {

//! The fields of a file by their paths, such as "cam0/intrinsics": each is a list of words, those of lists in a list in
//! one row. It is what is common to YAML and INI files.
class CV_EXPORTS CalibrationText
{
public:
    typedef std::map<std::string, std::vector<std::string>> Fields;

    /** Of text: YAML, or INI if it begins with a section. Of YAML, it reads maps in blocks, lists in blocks and in
    brackets, and words with and without quotes; tags are left out. cv::FileStorage reads none without its own header.
    @throws cv::Exception with the file and the line. */
    CalibrationText(const std::string& file, const std::string& text);

    const std::string& file() const { return file_; }

    bool has(const std::string& path) const { return fields_.count(path) != 0; }
    //! Whether a path begins so
    bool hasBelow(const std::string& prefix) const;

    // These throw an exception with the file and the path if that is not there, or something else.

    std::string word(const std::string& path) const;
    double number(const std::string& path) const { return numbers(path, 1)[0]; }
    //! Finite numbers, of this count unless it is 0
    std::vector<double> numbers(const std::string& path, size_t count) const;

    //! Throws an exception: the file, the path, and what is expected of it.
    void fail(const std::string& path, const std::string& expected) const;

private:
    std::string file_;
    Fields fields_;
};

//! readStereoCalibration() of one or two texts; size: of the raw images
CV_EXPORTS StereoCalibration toCalibration(const std::vector<CalibrationText>& texts, Size size, double unit);

}}} // namespace cv::stereo::hdp

#endif
