// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TOOLS_HDPSTEREO_WINDOWED_PAIR_HPP
#define OPENCV_HDPSTEREO_TOOLS_HDPSTEREO_WINDOWED_PAIR_HPP

#include "options.hpp"
#include "windows.hpp"

//! A part of both images; a mask is empty if there is data everywhere
struct PairPart
{
    cv::Mat left, right, leftMask, rightMask;
};

//! A pair with all that is known of its pixels beforehand, read by parts. All throws cv::Exception.
class WindowedPair
{
public:
    //! LEFT, RIGHT, --left-mask, --right-mask, --smallest, --largest, --prior: all of one size
    explicit WindowedPair(const cv::CommandLineParser& parser);

    cv::Size size() const { return size_; }
    //! Of both images
    int type() const { return std::max(left_.windows->type(), right_.windows->type()); } // grey or BGR, see makeAlike()
    //! Of all files, for each pixel of an image
    int bytesInMemory() const;
    //! The files that are not read by windows
    std::vector<cv::String> readWhole() const;

    PairPart read(const cv::Rect& part) const;
    //! Both images, halved some times
    PairPart reduced(int times) const;
    //! Throws if --largest is less than --smallest somewhere, or one of them is beyond what a matcher takes.
    void checkLimits() const;
    //! Whether --smallest and --largest limit all pixels, and to which range
    bool limitsAll(double& smallest, double& largest) const;
    //! Gives a matcher the ranges and the prior of a part.
    void setKnownDisparities(const cv::CommandLineParser& parser, const cv::Rect& part,
                             cv::stereo::HDPTreeMatcher& matcher) const;

private:
    struct File
    {
        cv::String path;
        cv::Ptr<ImageWindows> windows; // empty without the option
    };

    File open(const cv::CommandLineParser& parser, const char* option, const char* name);
    std::vector<File> files() const { return { left_, right_, leftMask_, rightMask_, smallest_, largest_, prior_ }; }

    static void readSide(const File& image, const File& maskFile, const cv::Rect& part, cv::Mat& pixels, cv::Mat& mask);
    static cv::Mat readMap(const File& map, const cv::Rect& part);
    template <typename Use> bool forLimits(const Use& use) const;

    cv::Size size_; // of the first one that is opened
    File left_, right_, leftMask_, rightMask_, smallest_, largest_, prior_;
};

#endif
