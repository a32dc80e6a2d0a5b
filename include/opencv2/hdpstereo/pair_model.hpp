// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#ifndef OPENCV_HDPSTEREO_PAIR_MODEL_HPP
#define OPENCV_HDPSTEREO_PAIR_MODEL_HPP

#include "opencv2/core.hpp"

namespace cv { namespace stereo {

//! @addtogroup hdpstereo
//! @{

/** @brief All that HDPTreeMatcher::compute() estimates from a pair before it is matched, as one value.

HDPTreeMatcher::getPairModel() returns that of the last pair. HDPTreeMatcher::setPairModel() sets it for the next ones,
and nothing is estimated from these: the frames of one rig, or the tiles of one pair, which by themselves would differ
in what is estimated, and so at their borders.

@code{.cpp}
    matcher->compute(left, right, disparity); // of a part that shows what the whole does, or of the whole at a quarter
    const PairModel model = matcher->getPairModel();
    model.save("rig.yml");
    matcher->setPairModel(model.tile(tile));
    matcher->compute(left(tile), right(tile), disparity);
@endcode

Points of the right image are counted from the centre of the image as it is matched: moved to the right by minDisparity,
with addedColumns more on the left. With a minDisparity of 0 this is the image itself.
 */
struct CV_EXPORTS_W_SIMPLE PairModel
{
    //! An empty model, of no images: see HDPTreeMatcher::setPairModel()
    CV_WRAP PairModel();

    //! Whether it is of no images
    CV_WRAP bool empty() const { return width == 0; }

    /** @brief Returns the model for a part of the images.

    Rows and light depend on the place in the image; the tile's pixels get those of the whole there. Black borders are
    those of the sides of the whole that the tile has: what lies in a border and shows none of these sides is matched,
    unless HDPTreeMatcher::setMasks() says otherwise.
    @param x First column of the tile in the whole images: a multiple of 2^(layers - 1), or compute() throws. So the
    pyramid is the same. 32 is one for up to 6 layers, 1400 disparities.
    @param y First row of the tile, likewise.
    @param tileWidth Of the tile, > 0.
    @param tileHeight Of the tile, > 0.
    @throws cv::Exception if the model is empty, or the tile not inside of the images.
     */
    CV_WRAP PairModel tile(int x, int y, int tileWidth, int tileHeight) const;

    //! The same of a rectangle
    PairModel tile(const Rect& rect) const { return tile(rect.x, rect.y, rect.width, rect.height); }

    /** @brief Returns the model for images that this one's are a reduction of, by means of squares of pixels.

    For images that are too large to be matched at once: rows and light are found in the reduced pair, and black and
    white, beyond which levels are cut off. Where only the finest texture is dark or bright, set these two yourself.
    @param times How often the images were halved, 0..15; minDisparity and numDisparities, too.
    @param width Of the larger images: this model's times 2^times, or up to 2^times - 1 more.
    @param height Of the larger images, likewise.
    @throws cv::Exception if the model is empty or of a tile, or sizes do not fit.
     */
    CV_WRAP PairModel enlarged(int times, int width, int height) const;

    CV_PROP_RW int width;          //!< of the images, in pixels, > 0; 0: the model is empty. Up to 2^24
    CV_PROP_RW int height;         //!< of the images, in pixels, likewise
    CV_PROP_RW int depth;          //!< of the images: CV_8U, CV_16U or CV_32F
    CV_PROP_RW int x;              //!< first column of the tile that is matched, >= 0; 0 without tiles
    CV_PROP_RW int y;              //!< first row of the tile, >= 0
    CV_PROP_RW int tileWidth;      //!< of the tile, in pixels, > 0; width without tiles
    CV_PROP_RW int tileHeight;     //!< of the tile, likewise
    CV_PROP_RW int minDisparity;   //!< that the images were matched with. A matcher keeps its own range, if it has one
    CV_PROP_RW int numDisparities; //!< the same, > 0
    CV_PROP_RW int addedColumns;   //!< that a negative minDisparity added on the left of the images, >= 0

    //! As HDPTreeMatcher::Findings::rows, of points counted as above: 5 finite numbers, whose terms move pixels by at
    //! most 2^24 rows.
    CV_PROP_RW std::vector<double> rows;
    //! Whether the rows of the right image are moved by them
    CV_PROP_RW bool areRowsMoved;

    //! Coefficients of HDPTreeMatcher::Findings::light: 10 numbers from -10^6 to 10^6.
    CV_PROP_RW std::vector<double> light;
    //! Whether the light of the right image is changed by them, for HDPTreeMatcher::COST_CENSUS
    CV_PROP_RW bool isLightChanged;

    //! HDPTreeMatcher::Findings::rowError, 0..2^24 pixels; 0: unknown
    CV_PROP_RW double rowError;

    CV_PROP_RW double noise;   //!< as HDPTreeMatcher::Findings::noise, of noiseLayer, 0..10000
    CV_PROP_RW int noiseLayer; //!< the layer in which it was measured, 0..15; 0 is the image

    //! Level that is matched as black, see HDPTreeMatcher: finite. Of CV_8U and CV_16U for HDPTreeMatcher::COST_CENSUS,
    //! >= 0.
    CV_PROP_RW double black;
    //! Level that is matched as white: finite, >= black. Of CV_8U and CV_16U <= 65536; black: these stay as they are.
    CV_PROP_RW double white;
    //! Level that ends black borders of the images, as rectification leaves them, which are no data, see
    //! HDPTreeMatcher::setMasks(): 0..65535; 0: there are none
    CV_PROP_RW double borderLevel;
    CV_PROP_RW int bits; //!< that levels of CV_16U have: 8..16. For CV_8U 8
    //! What the dark levels of a dark pair are brightened by, for HDPTreeMatcher::COST_CENSUS: 1..4. From 1 to 2 and
    //! from 2 to 4, fewer and fewer of the bright levels are compressed.
    CV_PROP_RW double brightness;
    //! Whether the left image has no colours: edges are those of its grey levels then, for HDPTreeMatcher::COST_CENSUS.
    CV_PROP_RW bool isGrey;

    //! First column, 0..7, of a block of JPEG compression, and the mean step between blocks in grey levels of 0 to 255,
    //! finite, >= 0; 0: there are none in this image, and nothing is smoothed in either. See Params::noiseThreshold.
    CV_PROP_RW int leftBlockStart;
    CV_PROP_RW double leftBlockStep;  //!< see leftBlockStart
    CV_PROP_RW int rightBlockStart;   //!< the same of the right image
    CV_PROP_RW double rightBlockStep; //!< the same of the right image

    /** @brief Writes the model to a file.
    @param filename XML, YAML or JSON, by its extension.
    @throws cv::Exception if it cannot be written, or a value is not valid: load() reads what is written. */
    CV_WRAP void save(const String& filename) const;

    /** @brief Reads what save() has written.
    @param filename XML, YAML or JSON.
    @throws cv::Exception if the file cannot be read, or a value is missing or not valid. */
    CV_WRAP static PairModel load(const String& filename);

    /** @brief Reads what write() has stored.
    @throws cv::Exception if a value is missing or not valid; the model is unchanged. */
    void read(const FileNode& fn);

    //! Stores all fields by name. Throws cv::Exception if a value is not valid, before anything is stored.
    void write(FileStorage& fs) const;
};

//! @}

}} // namespace cv::stereo

#endif
