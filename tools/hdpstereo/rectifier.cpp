// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "files.hpp"

#include <fstream>
#include <iterator>
#include "rectifier.hpp"
#include "windows.hpp"

using namespace cv;
using cv::stereo::HDPTreeMatcher;
using cv::stereo::StereoRig;

Rectifier::Rectifier(const CommandLineParser& parser)
    : first_(parser.get<String>("calibration")),
      second_(parser.get<String>("calibration2")), rawMasks_{ parser.get<String>("left-mask"),
                                                              parser.get<String>("right-mask") },
      unit_(numberOf(parser, "unit")), fieldOfView_(numberOf(parser, "field-of-view"))
{
    for (const String& path : { first_, second_ }) // a mistake of the call, not of a pair
        if (!path.empty())
            requireFile(path);
}

bool Rectifier::apply(Mat& left, Mat& right, const Mat& leftMask, const Mat& rightMask, HDPTreeMatcher& matcher)
{
    if (first_.empty())
        return false;
    const bool isUsual = leftMask.empty() && rightMask.empty();
    if (!rig_ || rig_->getSize() != left.size())
    {
        const Ptr<StereoRig> rig =
            StereoRig::create(cv::stereo::readStereoCalibration(first_, second_, left.size(), unit_), fieldOfView_);
        setMasks(leftMask, rightMask, *rig, matcher);
        rig_ = rig;
    }
    else if (!isUsual || !areMasksUsual_)
        setMasks(leftMask, rightMask, *rig_, matcher);
    areMasksUsual_ = isUsual;
    rig_->rectify(left, right, left, right);
    return true;
}

void Rectifier::setMasks(const Mat& left, const Mat& right, StereoRig& rig, HDPTreeMatcher& matcher) const
{
    const Size size = rig.getSize();
    Mat raw[2], masks[2];
    for (int i = 0; i < 2; i++)
    {
        raw[i] = joinMasks(rawMasks_[i].empty() ? Mat() : readMask(rawMasks_[i]), i == 0 ? left : right);
        if (raw[i].empty())
            raw[i] = Mat(size, CV_8U, Scalar(255));
        if (raw[i].size() != size)
            CV_Error(Error::StsUnmatchedSizes,
                     format("--%s-mask must have the size of the raw images, %d x %d, not %d x %d",
                            i == 0 ? "left" : "right", size.width, size.height, raw[i].cols, raw[i].rows));
    }
    rig.rectify(raw[0], raw[1], masks[0], masks[1]); // what is not reached, or beside something masked, is below 255
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
    const auto writeText = [&](const char* name, const String& path) {
        std::ifstream file(path.c_str());
        const String text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
        fs << name << "[";
        for (size_t i = 0; i < text.size(); i += 1000) // a string of FileStorage has less than 4096 characters
            fs << text.substr(i, 1000);
        fs << "]";
    };
    writeText("calibration", first_);
    writeText("calibration2", second_);
    fs << "unit" << unit_ << "fieldOfView" << fieldOfView_;
}
