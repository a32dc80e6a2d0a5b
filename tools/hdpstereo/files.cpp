// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "files.hpp"
#include "../paths.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>
#ifdef __unix__
#include <sys/stat.h>
#include <unistd.h>
#endif

#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

using namespace cv;

String extensionOf(const String& path)
{
    String extension = path.substr(std::min(path.rfind('.'), path.size()));
    for (char& letter : extension)
        letter = (char)std::tolower((unsigned char)letter);
    return extension;
}

static void failToWrite(const String& path, const String& why = String())
{
    CV_Error(Error::StsError, "cannot write '" + path + "'" + (why.empty() ? why : ": " + why));
}

void requireFile(const String& path)
{
    if (!utils::fs::exists(path) || utils::fs::isDirectory(path))
        CV_Error(Error::StsObjectNotFound, "there is no file '" + path + "'");
}

//! Whether another file may take the place of what has this name: not of a device or a pipe
static bool isReplaceable(const String& path)
{
#ifdef __unix__
    struct stat status;
    return stat(path.c_str(), &status) != 0 || S_ISREG(status.st_mode);
#else
    (void)path;
    return true;
#endif
}

//! Of the file itself, not of a link to it
static String targetOf(const String& path) { return utils::fs::exists(path) ? utils::fs::canonical(path) : path; }

//! Where a file is until it is whole
static String partOf(const String& target) { return isReplaceable(target) ? target + ".part" : target; }

//! Of what is there. It is not opened: the reader of a pipe would take that for the end of the file.
static bool isWritable(const String& path)
{
#ifdef __unix__
    return !utils::fs::isDirectory(path) && access(path.c_str(), W_OK) == 0;
#else
    return !!std::ofstream(path.c_str(), std::ios::app);
#endif
}

//! Whether a file can be made; it is not kept.
static bool isCreatable(const String& path)
{
    const bool isMade = !!std::ofstream(path.c_str(), std::ios::app);
    if (isMade)
        std::remove(path.c_str());
    return isMade;
}

void requireFolderOf(const String& path)
{
    const String folder = utils::fs::getParent(path);
    if (!folder.empty() && !utils::fs::isDirectory(folder))
        failToWrite(path, "there is no folder '" + folder + "'");
    if (utils::fs::isDirectory(path))
        failToWrite(path, "it is a folder");
    const String part = partOf(targetOf(path));
    if (!(utils::fs::exists(part) ? isWritable(part) : isCreatable(part)))
        failToWrite(path);
}

static void requireImageWriter(const String& path)
{
    requireFolderOf(path);
    if (!haveImageWriter(path))
        failToWrite(path, "no image format has this extension");
}

//! Throws if such an image cannot be written: formats differ in what they have, and OpenEXR may be switched off.
static void requireEncoder(const String& path, const Mat& image, const String& what)
{
    try
    {
        encode(extensionOf(path), image);
    }
    catch (const cv::Exception&)
    {
        failToWrite(path, "this OpenCV does not write " + what + extensionOf(path));
    }
}

void requirePictureWriter(const String& path)
{
    requireImageWriter(path);
    requireEncoder(path, Mat(64, 64, CV_8UC3, Scalar(0)), "colors as "); // JPEG 2000 takes none below 32 x 32
}

void requireMapWriter(const String& path)
{
    requireImageWriter(path);
    const String extension = extensionOf(path);
    const String formats[] = { ".png", ".pfm", ".tif", ".tiff", ".exr" };
    if (std::count(std::begin(formats), std::end(formats), extension) == 0)
        failToWrite(path, "disparities need .png, .pfm, .tif or .exr");
    requireEncoder(path, Mat(1, 1, extension == ".png" ? CV_16U : CV_32F, Scalar(0)), "");
}

bool isSameFile(const String& path, const String& other)
{
    return !path.empty() && !other.empty() && hdp_tools::placeOf(path) == hdp_tools::placeOf(other);
}

std::vector<uchar> encode(const String& extension, const Mat& image)
{
    std::vector<uchar> bytes;
    // PFM goes by a temporary file, of which there is less than the pixels if it does not fit.
    if (!imencode(extension, image, bytes) || (extension == ".pfm" && bytes.size() < image.total() * image.elemSize()))
        CV_Error(Error::StsError, "cannot encode " + extension + ": is the folder of temporary files full?");
    return bytes;
}

void writeFile(const String& path, const std::vector<uchar>& bytes)
{
    std::ofstream file(path.c_str(), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    file.close();
    if (!file)
        failToWrite(path);
}

PartFile::PartFile(const String& path) : path_(targetOf(path)), isOpen_(isReplaceable(path_)), name_(partOf(path_)) {}

PartFile::~PartFile()
{
    if (isOpen_)
        std::remove(name_.c_str());
}

void PartFile::finish()
{
    if (!isOpen_)
        return;
#ifdef _WIN32
    std::remove(path_.c_str()); // or rename() fails
#endif
    if (std::rename(name_.c_str(), path_.c_str()) != 0)
        failToWrite(path_);
    isOpen_ = false;
}

void writeFindings(const String& path, const cv::stereo::PairModel& model)
{
    FileStorage fs(extensionOf(path), FileStorage::WRITE | FileStorage::MEMORY);
    fs << "pairModel"
       << "{";
    model.write(fs);
    fs << "}";
    const String text = fs.releaseAndGetString();
    writeWholeFile(path, std::vector<uchar>(text.begin(), text.end()));
}

void writeWholeFile(const String& path, const std::vector<uchar>& bytes)
{
    PartFile part(path);
    writeFile(part.name(), bytes);
    part.finish();
}

Mat readImage(const String& path, int flags)
{
    const Mat image = imread(path, flags);
    if (image.empty())
        CV_Error(Error::StsError, "cannot read the image '" + path + "'");
    return image;
}

void requireKnownColors(const String& path, const Mat& image)
{
    if (image.channels() > 1 && image.depth() != CV_8U && image.depth() != CV_16U)
        CV_Error(Error::StsUnsupportedFormat,
                 "'" + path + "' has colours of floats: images are of 8 or 16 bit, or grey floats");
}

Mat readMask(const String& path) { return readImage(path, IMREAD_GRAYSCALE | IMREAD_ANYDEPTH) != 0; }

Mat toDisparity(const Mat& image, const Mat& mask, const String& path)
{
    const float none = std::numeric_limits<float>::quiet_NaN();
    if (image.type() != CV_16UC1 && image.type() != CV_32FC1)
        CV_Error(Error::StsUnsupportedFormat, "'" + path + "' must have disparities of 16 bit, times 256, or floats");
    Mat disparity;
    image.convertTo(disparity, CV_32F, image.depth() == CV_16U ? 1. / 256 : 1);
    if (image.depth() == CV_16U)
        disparity.setTo(none, image == 0);
    else
        disparity.setTo(none, (disparity == std::numeric_limits<float>::infinity()) |
                                  (disparity == -std::numeric_limits<float>::infinity()));
    if (!mask.empty())
        disparity.setTo(none, ~mask);
    return disparity;
}

Mat readPicture(const String& path)
{
    const auto isFloat = [](const Mat& image) { return image.depth() != CV_8U && image.depth() != CV_16U; };
    Mat image = imread(path, IMREAD_COLOR | IMREAD_ANYDEPTH);
    if (image.empty() || isFloat(image)) // TIFF of grey floats is no colour image, and of others colours are made
    {
        image.release();
        image = readImage(path, IMREAD_UNCHANGED);
        requireKnownColors(path, image);
    }
    if (isFloat(image)) // doubles, and numbers with a sign, too
        image.convertTo(image, CV_32F);
    if (image.depth() != CV_8U && image.channels() > 1)
        cvtColor(image, image, image.channels() == 4 ? COLOR_BGRA2GRAY : COLOR_BGR2GRAY);
    return image;
}

std::vector<uchar> encodeDisparity(const String& extension, const Mat& disparity)
{
    const float none = std::numeric_limits<float>::infinity();
    if (extension == ".tif" || extension == ".tiff") // whose readers know NaN
    {
        Mat map = disparity.clone();
        map.setTo(std::numeric_limits<float>::quiet_NaN(), disparity == none);
        return encode(extension, map);
    }
    if (extension != ".png")
        return encode(extension, disparity);
    const Mat outside = (disparity < 0) | (disparity >= 256);
    const int lost = countNonZero(outside & (disparity < none));
    if (lost > 0)
        std::cerr << "warning: " << lost << " pixels have disparities below 0 or from 256 on, and PNG has none: take "
                  << ".pfm, .tif or .exr" << std::endl;
    Mat disparity256;
    disparity.convertTo(disparity256, CV_16U, 256);
    disparity256.setTo(1, disparity256 == 0); // 0 stands for none
    disparity256.setTo(0, outside);
    return encode(extension, disparity256);
}
