// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "files.hpp"
#include "rectifier.hpp"

#include "opencv2/imgcodecs.hpp"

using namespace cv;
using cv::stereo::HDPTreeMatcher;
using cv::stereo::StereoRig;

Rectifier::Rectifier(const CommandLineParser& parser)
    : first_(parser.get<String>("calibration")),
      second_(parser.get<String>("calibration2")), rawMasks_{ parser.get<String>("left-mask"),
                                                              parser.get<String>("right-mask") },
      unit_(numberOf(parser, "unit")), fieldOfView_(numberOf(parser, "field-of-view"))
{
    if (first_.empty() && !second_.empty())
        CV_Error(Error::StsBadArg, "--calibration2 needs --calibration");
    for (const String& path : { first_, second_ }) // a mistake of the call, not of a pair
        if (!path.empty())
            requireFile(path);
}

bool Rectifier::apply(Mat& left, Mat& right, HDPTreeMatcher& matcher)
{
    if (first_.empty())
        return false;
    if (!rig_ || rig_->getSize() != left.size())
    {
        rig_ = StereoRig::create(cv::stereo::readStereoCalibration(first_, second_, left.size(), unit_), fieldOfView_);
        setMasks(matcher);
    }
    rig_->rectify(left, right, left, right);
    return true;
}

void Rectifier::setMasks(HDPTreeMatcher& matcher) const
{
    Mat raw[2], masks[2];
    for (int i = 0; i < 2; i++)
    {
        raw[i] =
            rawMasks_[i].empty() ? Mat(rig_->getSize(), CV_8U, Scalar(255)) : readImage(rawMasks_[i], IMREAD_GRAYSCALE);
        raw[i].setTo(255, raw[i]);
    }
    rig_->rectify(raw[0], raw[1], masks[0], masks[1]); // what is not reached, or beside something masked, is below 255
    for (Mat& mask : masks)
    {
        mask = mask == 255;
        if (countNonZero(mask) == (int)mask.total())
            mask.release();
    }
    matcher.setMasks(masks[0], masks[1]);
}

void Rectifier::write(FileStorage& fs) const
{
    if (first_.empty())
        return;
    fs << "calibration" << first_ << "calibration2" << second_ << "unit" << unit_ << "fieldOfView" << fieldOfView_;
}
