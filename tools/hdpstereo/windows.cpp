// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "windows.hpp"

#include "files.hpp"

#include "opencv2/imgproc.hpp"

#include <climits>
#include <cmath>
#ifdef HDPSTEREO_TIFF
#include <cstdlib>
#include <memory>
#include <tiffio.h>
#endif

using namespace cv;

namespace {

//! 255 where pixels are not what stands for no data, by all samples but a fourth one, alpha; empty if nothing does
Mat maskOf(const Mat& pixels, double noData)
{
    if (std::isnan(noData)) // floats that are NaN need no mask
        return Mat();
    Scalar least = Scalar::all(noData), most = least;
    if (pixels.channels() == 4)
    {
        least[3] = 0;
        most[3] = USHRT_MAX;
    }
    Mat missing;
    inRange(pixels, least, most, missing);
    return ~missing;
}

class WholeImage : public ImageWindows
{
public:
    WholeImage(const String& path, double noData) : image_(readPicture(path)), noData_(noData) {}
    Size size() const CV_OVERRIDE { return image_.size(); }
    int type() const CV_OVERRIDE { return image_.type(); }
    int bytesInMemory() const CV_OVERRIDE { return (int)image_.elemSize(); }
    Mat read(const Rect& part, Mat& mask) CV_OVERRIDE
    {
        mask = maskOf(image_(part), noData_);
        return image_(part);
    }

private:
    Mat image_;
    double noData_;
};

class WholeMap : public MapTiles
{
public:
    WholeMap(const String& path, Size size) : path_(path), map_(size, CV_32F) {}
    void write(const Mat& disparity, const Rect& part) CV_OVERRIDE { disparity.copyTo(map_(part)); }
    void finish() CV_OVERRIDE { writeWholeFile(path_, encodeDisparity(extensionOf(path_), map_)); }

private:
    String path_;
    Mat map_;
};

#ifdef HDPSTEREO_TIFF

bool isTiff(const String& path)
{
    const String extension = extensionOf(path);
    return extension == ".tif" || extension == ".tiff";
}

struct TiffCloser
{
    void operator()(TIFF* file) const { TIFFClose(file); }
};

typedef std::unique_ptr<TIFF, TiffCloser> Tiff;

template <typename T> T fieldOf(TIFF* file, uint32_t tag)
{
    T value = T();
    TIFFGetFieldDefaulted(file, tag, &value);
    return value;
}

//! The level that stands for no data, which GDAL writes as text; NaN if there is none
double noDataOf(TIFF* file)
{
    const uint32_t tag = 42113;
    const TIFFField* const field = TIFFFindField(file, tag, TIFF_ANY);
    uint32_t count = 0;
    const char* characters = nullptr;
    String text;
    if (field && TIFFFieldPassCount(field)) // unless GDAL is loaded, too, libtiff does not know the tag
    {
        if (TIFFGetField(file, tag, &count, &characters))
            text.assign(characters, count);
    }
    else if (field && TIFFGetField(file, tag, &characters))
        text = characters;
    char* end = nullptr;
    const double level = std::strtod(text.c_str(), &end);
    return end == text.c_str() ? std::numeric_limits<double>::quiet_NaN() : level;
}

//! A TIFF of strips or tiles, of one to four interleaved samples of 8 or 16 bit, or one of floats
class TiffWindows : public ImageWindows
{
public:
    //! file: closed by this
    TiffWindows(const String& path, TIFF* file) : path_(path), file_(file)
    {
        TIFF* const f = file_.get();
        size_ = Size((int)fieldOf<uint32_t>(f, TIFFTAG_IMAGEWIDTH), (int)fieldOf<uint32_t>(f, TIFFTAG_IMAGELENGTH));
        bits_ = fieldOf<uint16_t>(f, TIFFTAG_BITSPERSAMPLE);
        samples_ = fieldOf<uint16_t>(f, TIFFTAG_SAMPLESPERPIXEL);
        isTiled_ = TIFFIsTiled(f) != 0;
        noData_ = noDataOf(f);
        block_ = isTiled_
                     ? Size((int)fieldOf<uint32_t>(f, TIFFTAG_TILEWIDTH), (int)fieldOf<uint32_t>(f, TIFFTAG_TILELENGTH))
                     : Size(size_.width, (int)std::min<uint32_t>(fieldOf<uint32_t>(f, TIFFTAG_ROWSPERSTRIP),
                                                                 (uint32_t)size_.height));
    }

    //! Whether parts are less work than the whole, and mean what they mean to imread()
    bool isReadable() const
    {
        TIFF* const f = file_.get();
        const int photometric = fieldOf<uint16_t>(f, TIFFTAG_PHOTOMETRIC),
                  format = fieldOf<uint16_t>(f, TIFFTAG_SAMPLEFORMAT);
        const bool isGrey = samples_ == 1 && photometric == PHOTOMETRIC_MINISBLACK;
        const bool isColored = (samples_ == 3 || samples_ == 4) && photometric == PHOTOMETRIC_RGB;
        const bool isWhole = (bits_ == 8 || bits_ == 16) && format == SAMPLEFORMAT_UINT && (isGrey || isColored),
                   isFloat = bits_ == 32 && format == SAMPLEFORMAT_IEEEFP && isGrey;
        return (isWhole || isFloat) && fieldOf<uint16_t>(f, TIFFTAG_PLANARCONFIG) == PLANARCONFIG_CONTIG &&
               fieldOf<uint16_t>(f, TIFFTAG_ORIENTATION) == ORIENTATION_TOPLEFT && !size_.empty() && !block_.empty() &&
               (isTiled_ || block_.height < size_.height);
    }

    Size size() const CV_OVERRIDE { return size_; }
    int type() const CV_OVERRIDE { return CV_MAKETYPE(depth(), depth() == CV_8U && samples_ > 1 ? 3 : 1); }
    int bytesInMemory() const CV_OVERRIDE { return 0; }
    double noData() const { return noData_; }

    Mat read(const Rect& part, Mat& mask) CV_OVERRIDE
    {
        const int stored = CV_MAKETYPE(depth(), samples_);
        Mat pixels(part.size(), stored), block(block_, stored);
        for (int y = part.y / block_.height * block_.height; y < part.br().y; y += block_.height)
            for (int x = part.x / block_.width * block_.width; x < part.br().x; x += block_.width)
            {
                readBlock(x, y, block);
                const Rect inside = Rect(Point(x, y), block_) & part;
                block(inside - Point(x, y)).copyTo(pixels(inside - part.tl()));
            }
        mask = maskOf(pixels, noData_);
        Mat image;
        if (samples_ == 1)
            return pixels;
        const bool hasAlpha = samples_ == 4;
        if (bits_ == 16)
            cvtColor(pixels, image, hasAlpha ? COLOR_RGBA2GRAY : COLOR_RGB2GRAY);
        else
            cvtColor(pixels, image, hasAlpha ? COLOR_RGBA2BGR : COLOR_RGB2BGR);
        return image;
    }

private:
    int depth() const { return bits_ == 8 ? CV_8U : bits_ == 16 ? CV_16U : CV_32F; }

    void readBlock(int x, int y, Mat& block)
    {
        TIFF* const f = file_.get();
        const uint32_t number =
            isTiled_ ? TIFFComputeTile(f, (uint32_t)x, (uint32_t)y, 0, 0) : TIFFComputeStrip(f, (uint32_t)y, 0);
        // A sparse file of GDAL does not have it, and libtiff would read the beginning of the file.
        if (TIFFGetStrileByteCount(f, number) == 0)
        {
            block.setTo(Scalar::all(std::isnan(noData_) ? 0 : noData_));
            return;
        }
        const tmsize_t bytes = (tmsize_t)(block.total() * block.elemSize());
        const tmsize_t done = isTiled_ ? TIFFReadEncodedTile(f, number, block.data, bytes)
                                       : TIFFReadEncodedStrip(f, number, block.data, bytes);
        if (done < 0)
            CV_Error(Error::StsError, "cannot read the image '" + path_ + "'");
    }

    String path_;
    Tiff file_;
    Size size_, block_;
    double noData_;
    int bits_, samples_;
    bool isTiled_;
};

class TiffMap : public MapTiles
{
public:
    TiffMap(const String& path, Size size, int side) : path_(path), part_(path)
    {
        const auto tileOf = [=](int length) { return std::min(side, (length + 15) / 16 * 16); }; // multiples of 16
        tile_ = Size(tileOf(size.width), tileOf(size.height));
        const auto padded = [](int length, int tile) { return std::ceil((double)length / tile) * tile; };
        const bool isBig = 4 * padded(size.width, tile_.width) * padded(size.height, tile_.height) > 4e9;
        file_.reset(TIFFOpen(part_.name().c_str(), isBig ? "w8" : "w"));
        if (!file_)
            fail();
        TIFF* const f = file_.get();
        TIFFSetField(f, TIFFTAG_IMAGEWIDTH, (uint32_t)size.width);
        TIFFSetField(f, TIFFTAG_IMAGELENGTH, (uint32_t)size.height);
        TIFFSetField(f, TIFFTAG_TILEWIDTH, (uint32_t)tile_.width);
        TIFFSetField(f, TIFFTAG_TILELENGTH, (uint32_t)tile_.height);
        TIFFSetField(f, TIFFTAG_BITSPERSAMPLE, 32);
        TIFFSetField(f, TIFFTAG_SAMPLESPERPIXEL, 1);
        TIFFSetField(f, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
        TIFFSetField(f, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(f, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
        TIFFSetField(f, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    }
    void write(const Mat& disparity, const Rect& part) CV_OVERRIDE
    {
        TIFF* const f = file_.get();
        Mat tile(tile_, CV_32F, Scalar(std::numeric_limits<float>::quiet_NaN()));
        disparity.copyTo(tile(Rect(Point(), part.size())), disparity < std::numeric_limits<float>::infinity());
        const uint32_t number = TIFFComputeTile(f, (uint32_t)part.x, (uint32_t)part.y, 0, 0);
        if (TIFFWriteEncodedTile(f, number, tile.data, (tmsize_t)(tile.total() * tile.elemSize())) < 0)
            fail();
    }

    void finish() CV_OVERRIDE
    {
        if (!TIFFFlush(file_.get()))
            fail();
        file_.reset();
        part_.finish();
    }

private:
    void fail() const { CV_Error(Error::StsError, "cannot write '" + path_ + "'"); }

    String path_;
    PartFile part_;
    Size tile_;
    Tiff file_; // closed before what is not finished is removed
};

#endif

} // namespace

Ptr<ImageWindows> openImage(const String& path)
{
    double noData = std::numeric_limits<double>::quiet_NaN();
#ifdef HDPSTEREO_TIFF
    if (isTiff(path))
    {
        TIFFSetErrorHandler(nullptr); // errors are exceptions
        TIFFSetWarningHandler(nullptr);
        TIFF* const file = TIFFOpen(path.c_str(), "rm"); // not mapped into memory, which the whole file would take
        if (!file)
            CV_Error(Error::StsError, "cannot read the image '" + path + "'");
        const Ptr<TiffWindows> windows = makePtr<TiffWindows>(path, file);
        if (windows->isReadable())
            return windows;
        noData = windows->noData();
    }
#endif
    return makePtr<WholeImage>(path, noData);
}

Mat joinMasks(const Mat& given, const Mat& ofFile)
{
    if (given.empty())
        return ofFile;
    return given.size() == ofFile.size() ? Mat(given & ofFile) : given;
}

void makeAlike(Mat& left, Mat& right)
{
    if (left.depth() != CV_8U || right.depth() != CV_8U)
        return;
    if (left.channels() == 1 && right.channels() == 3)
        cvtColor(left, left, COLOR_GRAY2BGR);
    else if (left.channels() == 3 && right.channels() == 1)
        cvtColor(right, right, COLOR_GRAY2BGR);
}

Mat readPicture(const String& path, Mat& mask)
{
    const Ptr<ImageWindows> image = openImage(path);
    return image->read(Rect(Point(), image->size()), mask);
}

bool isWrittenByTiles(const String& path)
{
#ifdef HDPSTEREO_TIFF
    return isTiff(path);
#else
    (void)path;
    return false;
#endif
}

Ptr<MapTiles> createMap(const String& path, Size size, int side)
{
#ifdef HDPSTEREO_TIFF
    if (isTiff(path))
        return makePtr<TiffMap>(path, size, side);
#else
    (void)side;
#endif
    return makePtr<WholeMap>(path, size);
}
