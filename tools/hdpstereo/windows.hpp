// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_TOOLS_HDPSTEREO_WINDOWS_HPP
#define OPENCV_HDPSTEREO_TOOLS_HDPSTEREO_WINDOWS_HPP

#include "opencv2/core.hpp"

// Images that are read and written by parts. All throw cv::Exception.

//! An image in a file
class ImageWindows
{
public:
    virtual ~ImageWindows() {}
    virtual cv::Size size() const = 0;
    //! What read() returns
    virtual int type() const = 0;
    //! Bytes that are in memory for each pixel of the image
    virtual int bytesInMemory() const = 0;
    /** A part of it, inside of the image: grey or BGR in 8 bit, or grey in 16 bit or floats.
    @param mask Receives 0 where the file says that there is no data, by GDAL's tag of TIFF, and 255 elsewhere; empty if
    it does not have that tag. */
    virtual cv::Mat read(const cv::Rect& part, cv::Mat& mask) = 0;
};

//! Opens an image: TIFF of 8 or 16 bit or grey floats is read by windows if it has strips or tiles, is not to be turned,
//! and the program is built with libtiff; other images are read whole.
cv::Ptr<ImageWindows> openImage(const cv::String& path);

//! Which pixels have data by a mask that was given and by that of the image's file; either may be empty. The given one
//! if their sizes differ: compute() refuses it.
cv::Mat joinMasks(const cv::Mat& given, const cv::Mat& ofFile);

//! Of two pictures of 8 bit, one in grey levels and one in colours, both in colours: a grey PNG is read in these.
void makeAlike(cv::Mat& left, cv::Mat& right);

//! The whole of an image, and its mask, see ImageWindows::read()
cv::Mat readPicture(const cv::String& path, cv::Mat& mask);

//! A map that is written tile by tile
class MapTiles
{
public:
    virtual ~MapTiles() {}
    //! Writes a tile: disparities in pixels, infinite where there is none; part: where it is in the map.
    virtual void write(const cv::Mat& disparity, const cv::Rect& part) = 0;
    //! After the last one
    virtual void finish() = 0;
};

//! Whether createMap() does not need the whole map in memory
bool isWrittenByTiles(const cv::String& path);

/** Creates the map.
@param path FILE.tif: floats, NaN where there is no disparity, written by tiles if the program is built with libtiff. Or
as --output, which is in memory.
It gets its name when it is finished.
@param size Of the map.
@param side Of the tiles, a multiple of 16; those at the border may be smaller. */
cv::Ptr<MapTiles> createMap(const cv::String& path, cv::Size size, int side);

#endif
