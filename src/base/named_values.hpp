// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_NAMED_VALUES_HPP
#define OPENCV_HDPSTEREO_NAMED_VALUES_HPP

#include "opencv2/core.hpp"

#include <sstream>
#include <type_traits>

namespace cv { namespace stereo { namespace hdp {

// What is called for each value of a list: with its name, the value, whether it is valid, and what is, in words.

//! Throws if a value is not valid. prefix: of messages
struct ValueChecker
{
    const char* prefix;

    template <typename T>
    void operator()(const char* name, const T& value, bool isValid = true, const char* valid = "") const
    {
        if (isValid)
            return;
        std::ostringstream message;
        message << prefix << name << " must be " << valid << ", not " << value;
        CV_Error(Error::StsOutOfRange, message.str());
    }
    void operator()(const char* name, const std::vector<double>&, bool isValid, const char* valid) const
    {
        if (!isValid)
            CV_Error(Error::StsOutOfRange, format("%s%s must be %s", prefix, name, valid));
    }
};

struct ValueWriter
{
    FileStorage& fs;

    template <typename T> void operator()(const char* name, const T& value, bool = true, const char* = "") const
    {
        fs << name << value;
    }
};

//! Throws if what is there is no number. mayMiss: whether a value that is not there stays as it is
struct ValueReader
{
    const FileNode& fn;
    const char* prefix;
    bool mayMiss;

    template <typename T> void operator()(const char* name, T& value, bool = true, const char* = "") const
    {
        const FileNode node = fn[name];
        if (!node.empty() || !mayMiss)
            value = saturate_cast<T>(numberOf<T>(node, name));
    }
    void operator()(const char* name, std::vector<double>& numbers, bool, const char*) const
    {
        const FileNode node = fn[name];
        if (!node.isSeq() && !node.isInt() && !node.isReal()) // a sequence of one number in XML
            CV_Error(Error::StsParseError, format("%s%s must be a sequence of numbers", prefix, name));
        numbers.clear();
        for (const FileNode& number : node)
            numbers.push_back(numberOf<double>(number, name));
    }

private:
    template <typename T> double numberOf(const FileNode& node, const char* name) const
    {
        if (!node.isInt() && !(std::is_same<T, double>::value && node.isReal()))
            CV_Error(Error::StsParseError, format("%s%s must be a number", prefix, name));
        return (double)node;
    }
};

}}} // namespace cv::stereo::hdp

#endif
