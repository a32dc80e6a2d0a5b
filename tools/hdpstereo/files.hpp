// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TOOLS_HDPSTEREO_FILES_HPP
#define OPENCV_HDPSTEREO_TOOLS_HDPSTEREO_FILES_HPP

#include "opencv2/core.hpp"
#include "opencv2/hdpstereo.hpp"

// Images and maps in files. All throw cv::Exception.

//! In small letters
cv::String extensionOf(const cv::String& path);

//! Throws if there is no such file, or it is a folder.
void requireFile(const cv::String& path);

//! Throws if the folder of a file to write is not there, or there is no image format of its extension that has colors.
void requirePictureWriter(const cv::String& path);

//! The same, of maps: the format must have disparities.
void requireMapWriter(const cv::String& path);

//! Throws if the folder of a file to write is not there, or cannot be written to.
void requireFolderOf(const cv::String& path);

//! Whether both are one, whether it is there or not; an empty path is none.
bool isSameFile(const cv::String& path, const cv::String& other);

std::vector<uchar> encode(const cv::String& extension, const cv::Mat& image);

//! A map in pixels, infinite where there is none, as --output says. Warns of disparities that the format does not have.
std::vector<uchar> encodeDisparity(const cv::String& extension, const cv::Mat& disparity);

//! Unlike imwrite(), this notices a full disk.
void writeFile(const cv::String& path, const std::vector<uchar>& bytes);

//! A file that gets its name when it is whole, whatever becomes of this program meanwhile
class PartFile
{
public:
    explicit PartFile(const cv::String& path);
    PartFile(const PartFile&) = delete;
    PartFile& operator=(const PartFile&) = delete;
    ~PartFile(); //!< removes what is not finished

    //! To write to: beside the file, or a device itself
    const cv::String& name() const { return name_; }

    //! After it is closed
    void finish();

private:
    cv::String path_;
    bool isOpen_;
    cv::String name_;
};

//! By a PartFile
void writeWholeFile(const cv::String& path, const std::vector<uchar>& bytes);

//! As PairModel::save(), by a PartFile
void writeFindings(const cv::String& path, const cv::stereo::PairModel& model);

cv::Mat readImage(const cv::String& path, int flags);

//! Throws if an image has colours that are not of 8 or 16 bit: formats do not agree what white is.
void requireKnownColors(const cv::String& path, const cv::Mat& image);

//! 255 where a picture of any depth is not black, else 0
cv::Mat readMask(const cv::String& path);

//! A map as encodeDisparity() writes it, and its mask, as readPicture() has read them: CV_32F in pixels, NaN where there
//! is none
cv::Mat toDisparity(const cv::Mat& image, const cv::Mat& mask, const cv::String& path);

//! Colours in 8 bit, or grey levels in 16 bit or floats of a picture that has them
cv::Mat readPicture(const cv::String& path);

#endif
