// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TOOLS_HDPSTEREO_OPTIONS_HPP
#define OPENCV_HDPSTEREO_TOOLS_HDPSTEREO_OPTIONS_HPP

#include "opencv2/core/utility.hpp"
#include "opencv2/hdpstereo.hpp"

// What the command line asks for. All throw cv::Exception, with the option's name.

double numberOf(const cv::CommandLineParser& parser, const cv::String& option);
int integerOf(const cv::CommandLineParser& parser, const cv::String& option);

//! --num-disparities, or what is usual for images of a width
int numDisparitiesOf(const cv::CommandLineParser& parser, int width);

//! --findings
cv::stereo::PairModel findingsOf(const cv::CommandLineParser& parser);

//! Whether what is to be written for one pair can be, and is no input; before any work
void checkOutputs(const cv::CommandLineParser& parser);

//! For maps in PNG
void requireDisparitiesOfPng(const cv::CommandLineParser& parser);

//! Without masks, which MaskFiles and Rectifier set
cv::Ptr<cv::stereo::HDPTreeMatcher> createMatcher(const cv::CommandLineParser& parser, int width);

//! Without what it has to know of each pixel: masks, ranges and prior
cv::Ptr<cv::stereo::HDPTreeMatcher> createPlainMatcher(const cv::CommandLineParser& parser, int width);

//! --smallest and --largest, --prior and --prior-sigma; maps that are empty are missing
void setKnownDisparities(const cv::CommandLineParser& parser, const cv::Mat& smallest, const cv::Mat& largest,
                         const cv::Mat& prior, cv::stereo::HDPTreeMatcher& matcher);

//! --left-mask and --right-mask
class MaskFiles
{
public:
    explicit MaskFiles(const cv::CommandLineParser& parser);
    //! Sets them, with the masks of the images' own files; these may be empty.
    void apply(const cv::Mat& ofLeft, const cv::Mat& ofRight, cv::stereo::HDPTreeMatcher& matcher) const;

private:
    cv::Mat left_, right_;
};

// What the program does

void matchPair(const cv::CommandLineParser& parser);

//! --tiles. Returns the exit status.
int matchTiles(const cv::CommandLineParser& parser);

//! --batch. Returns how many pairs are bad.
size_t matchPairs(const cv::CommandLineParser& parser);

//! Disparities in pixels from those in CV_16S, infinite where there is none
cv::Mat inPixels(const cv::Mat& disparity16, int minDisparity);

cv::Mat computeDisparity(cv::stereo::HDPTreeMatcher& matcher, const cv::Mat& left, const cv::Mat& right);

#endif
