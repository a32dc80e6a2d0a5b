// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TOOLS_HDPSTEREO_RECTIFIER_HPP
#define OPENCV_HDPSTEREO_TOOLS_HDPSTEREO_RECTIFIER_HPP

#include "options.hpp"

//! --calibration: raw pairs become rectified ones; without it, pairs are taken to be rectified already.
class Rectifier
{
public:
    explicit Rectifier(const cv::CommandLineParser& parser);

    //! Also gives the matcher the masks of what no raw pixel reaches, or none that has data; --left-mask, --right-mask
    //! and those of the files are of raw images, and may be empty. Does nothing, and returns false, without
    //! --calibration.
    bool apply(cv::Mat& left, cv::Mat& right, const cv::Mat& leftMask, const cv::Mat& rightMask,
               cv::stereo::HDPTreeMatcher& matcher);

    //! Of the last pair; empty without --calibration
    const cv::Ptr<cv::stereo::StereoRig>& rig() const { return rig_; }

    //! The options, for those that must not change
    void write(cv::FileStorage& fs) const;

private:
    void setMasks(const cv::Mat& left, const cv::Mat& right, cv::stereo::StereoRig& rig,
                  cv::stereo::HDPTreeMatcher& matcher) const;

    const cv::String first_, second_, rawMasks_[2];
    const double unit_, fieldOfView_;
    bool areMasksUsual_ = false;         // those of pairs whose files have none
    cv::Ptr<cv::stereo::StereoRig> rig_; // for images of one size: another one is made when that changes
};

#endif
