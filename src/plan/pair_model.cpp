// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "pair_model.hpp"
#include "../base/named_values.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <fstream>

namespace cv { namespace stereo {

using namespace hdp;

namespace {

const int maxWhole = 1 << 24; // pixels of a side: columns are exact in floats

const double maxLight = 1e6; // levels of any place stay finite in floats

//! Whether there are so many, from -most to most
bool areNumbers(const std::vector<double>& numbers, int count, double most)
{
    const auto isValid = [most](double number) { return std::abs(number) <= most; };
    return (int)numbers.size() == count && std::all_of(numbers.begin(), numbers.end(), isValid);
}

const char* const prefix = "PairModel: "; // of messages

//! See named_values.hpp.
template <typename Model, typename Visit> void visitFields(Model& m, const Visit& visit)
{
    const auto isStep = [](double step) { return std::isfinite(step) && step >= 0; };
    const char* const notNegative = "finite and >= 0";
    visit("width", m.width, m.width > 0 && m.width <= maxWhole, "1..2^24");
    visit("height", m.height, m.height > 0 && m.height <= maxWhole, "1..2^24");
    visit("depth", m.depth, m.depth == CV_8U || m.depth == CV_16U || m.depth == CV_32F, "CV_8U, CV_16U or CV_32F");
    visit("tileWidth", m.tileWidth, m.tileWidth > 0 && m.tileWidth <= m.width, "1..width");
    visit("tileHeight", m.tileHeight, m.tileHeight > 0 && m.tileHeight <= m.height, "1..height");
    visit("x", m.x, m.x >= 0 && (int64)m.x + m.tileWidth <= m.width, "0..width - tileWidth");
    visit("y", m.y, m.y >= 0 && (int64)m.y + m.tileHeight <= m.height, "0..height - tileHeight");
    visit("minDisparity", m.minDisparity, std::abs((double)m.minDisparity) <= maxWhole, "-2^24..2^24");
    visit("numDisparities", m.numDisparities, m.numDisparities > 0 && m.numDisparities <= maxWhole, "1..2^24");
    visit("addedColumns", m.addedColumns, m.addedColumns >= 0 && m.addedColumns <= maxWhole, "0..2^24");
    visit("areRowsMoved", m.areRowsMoved, true, "");
    visit("isLightChanged", m.isLightChanged, true, "");
    visit("rowError", m.rowError, m.rowError >= 0 && m.rowError <= maxWhole, "0..2^24");
    visit("noise", m.noise, m.noise >= 0 && m.noise <= 10000, "0..10000");
    visit("noiseLayer", m.noiseLayer, m.noiseLayer >= 0 && m.noiseLayer <= 15, "0..15");
    const bool isFloat = m.depth == CV_32F;
    visit("black", m.black, std::isfinite(m.black) && (isFloat || m.black >= 0), "finite, and >= 0 without floats");
    visit("white", m.white, std::isfinite(m.white) && m.white >= m.black && (isFloat || m.white <= LevelScale::end),
          "finite and >= black, and <= 65536 without floats");
    visit("borderLevel", m.borderLevel, m.borderLevel >= 0 && m.borderLevel <= USHRT_MAX, "0..65535");
    visit("bits", m.bits, m.bits >= 8 && m.bits <= (m.depth == CV_8U ? 8 : 16), "8..16, and 8 for CV_8U");
    visit("brightness", m.brightness, m.brightness >= 1 && m.brightness <= 4, "1..4");
    visit("isGrey", m.isGrey, true, "");
    visit("leftBlockStart", m.leftBlockStart, m.leftBlockStart >= 0 && m.leftBlockStart < BlockGrid::side, "0..7");
    visit("leftBlockStep", m.leftBlockStep, isStep(m.leftBlockStep), notNegative);
    visit("rightBlockStart", m.rightBlockStart, m.rightBlockStart >= 0 && m.rightBlockStart < BlockGrid::side, "0..7");
    visit("rightBlockStep", m.rightBlockStep, isStep(m.rightBlockStep), notNegative);
    visit("rows", m.rows, areNumbers(m.rows, RowModel::terms, DBL_MAX), "5 finite numbers");
    visit("light", m.light, areNumbers(m.light, LightModel::terms, maxLight), "10 numbers of -10^6..10^6");
}

//! In 0 .. side - 1, as a column that begins a block
int blockStart(int column) { return (column % BlockGrid::side + BlockGrid::side) % BlockGrid::side; }

} // namespace

PairModel::PairModel()
    : width(0), height(0), depth(CV_8U), x(0), y(0), tileWidth(0), tileHeight(0), minDisparity(0), numDisparities(0),
      addedColumns(0), rows(RowModel::terms, 0.), areRowsMoved(false), light(LightModel::terms, 0.),
      isLightChanged(false), rowError(0), noise(0), noiseLayer(0), black(0), white(0), borderLevel(0), bits(8),
      brightness(1), isGrey(false), leftBlockStart(0), leftBlockStep(0), rightBlockStart(0), rightBlockStep(0)
{
    light[LightModel::gain] = 1; // changes nothing
}

PairModel PairModel::tile(int firstColumn, int firstRow, int columns, int rowCount) const
{
    if (empty())
        CV_Error(Error::StsBadArg, "PairModel: an empty model has no tiles");
    PairModel model = *this;
    model.x = firstColumn;
    model.y = firstRow;
    model.tileWidth = columns;
    model.tileHeight = rowCount;
    checkPairModel(model);
    return model;
}

PairModel PairModel::enlarged(int times, int largeWidth, int largeHeight) const
{
    if (empty() || tileWidth != width || tileHeight != height)
        CV_Error(Error::StsBadArg, "PairModel: only a model of whole images can be enlarged");
    if (times < 0 || times > 15)
        CV_Error(Error::StsOutOfRange, format("times must be 0..15, not %d", times));
    if (largeWidth >> times != width || largeHeight >> times != height)
        CV_Error(Error::StsUnmatchedSizes, format("width and height must be %d x %d times %d, not %d x %d", width,
                                                  height, 1 << times, largeWidth, largeHeight));
    checkPairModel(*this);
    const double scale = 1 << times;
    PairModel model = *this;
    model.width = model.tileWidth = largeWidth;
    model.height = model.tileHeight = largeHeight;
    model.minDisparity = saturate_cast<int>(minDisparity * scale);
    model.numDisparities = saturate_cast<int>(numDisparities * scale);
    model.addedColumns = saturate_cast<int>(addedColumns * scale);
    model.rowError = std::min(rowError * scale, (double)maxWhole);
    model.rows[0] *= scale;
    model.rows[3] /= scale;
    model.rows[4] /= scale;
    model.noiseLayer = std::min(noiseLayer + times, 15);
    model.leftBlockStep = model.rightBlockStep = 0; // blocks of the larger images are not seen in these
    checkPairModel(model);
    return model;
}

void PairModel::write(FileStorage& fs) const
{
    checkPairModel(*this);
    visitFields(*this, ValueWriter{ fs });
}

void PairModel::read(const FileNode& fn)
{
    if (!fn.isMap())
        CV_Error(Error::StsParseError, "PairModel: it must be a map");
    PairModel model;
    visitFields(model, ValueReader{ fn, prefix, false });
    checkPairModel(model);
    *this = model;
}

void PairModel::save(const String& filename) const
{
    checkPairModel(*this); // what was in the file stays
    const bool isCompressed = filename.size() > 3 && filename.substr(filename.size() - 3) == ".gz";
    FileStorage fs(filename, FileStorage::WRITE | (isCompressed ? 0 : FileStorage::MEMORY));
    bool isWritten = fs.isOpened();
    if (isWritten)
    {
        fs.startWriteStruct("pairModel", FileNode::MAP);
        write(fs);
        fs.endWriteStruct();
        if (!isCompressed) // a FileStorage does not notice a full disk
        {
            std::ofstream file(filename);
            file << fs.releaseAndGetString();
            file.close();
            isWritten = !file.fail();
        }
    }
    if (!isWritten)
        CV_Error(Error::StsError, "cannot write '" + filename + "'");
}

PairModel PairModel::load(const String& filename)
{
    PairModel model;
    try
    {
        const FileStorage fs(filename, FileStorage::READ);
        if (!fs.isOpened())
            CV_Error(Error::StsObjectNotFound, "cannot read it");
        if (!fs.root().isMap() || !fs["pairModel"].isMap())
            CV_Error(Error::StsParseError, "pairModel is missing");
        model.read(fs["pairModel"]);
    }
    catch (const cv::Exception& e) // neither the parser's nor read()'s name the file
    {
        CV_Error(e.code, "filename: '" + filename + "' does not hold a pair model: " + e.err);
    }
    return model;
}

namespace hdp {

void checkPairModel(const PairModel& model)
{
    if (model.empty())
        return;
    visitFields(model, ValueChecker{ prefix });
    // Tiles are moved by minDisparity, and rows are followed from there, see alignRow().
    const double moved = std::abs((double)model.minDisparity);
    const Point2d corner(0.5 * (model.width + model.addedColumns) + moved, 0.5 * model.height);
    if (norm(RowModel::basis(corner).mul(RowModel::Coefficients(model.rows.data())), NORM_L1) > maxWhole)
        CV_Error(Error::StsOutOfRange, "PairModel: rows must move pixels by at most 2^24 rows");
}

void checkPairModelOf(const PairModel& model, Size size, int type, int layers)
{
    if (model.empty())
        return;
    const char* const levels = model.depth == CV_32F  ? "levels of CV_32F"
                               : model.depth == CV_8U ? "8 bits per level"
                                                      : "16 bits per level";
    if (model.depth != CV_MAT_DEPTH(type))
        CV_Error(Error::StsUnmatchedFormats, format("left must have %s as the pair model, see setPairModel()", levels));
    if (size != Size(model.tileWidth, model.tileHeight))
        CV_Error(Error::StsUnmatchedSizes,
                 format("left must have %d x %d pixels as the pair model, not %d x %d, see setPairModel()",
                        model.tileWidth, model.tileHeight, size.width, size.height));
    const int least = 1 << (layers - 1); // a pixel of the top layer
    if (std::min(size.width, size.height) < least)
        CV_Error(Error::StsOutOfRange, format("left must have %d x %d pixels or more for %d layers, not %d x %d", least,
                                              least, layers, size.width, size.height));
    if (model.x % least != 0 || model.y % least != 0)
        CV_Error(Error::StsOutOfRange, format("PairModel: x and y must be multiples of %d for %d layers, not %d and %d",
                                              least, layers, model.x, model.y));
}

GivenPair toGivenPair(const PairModel& model, const PyramidPlan& plan, Size size)
{
    GivenPair given;
    const int moved = plan.extension + plan.minDisparity; // columns of the right image
    given.isGiven = !model.empty();
    given.frame = ImageFrame(size + Size(plan.extension, 0));
    if (!given.isGiven)
        return given;
    LevelFindings& levels = given.levels;
    levels.scale = LevelScale(model.bits, plan.isCensus ? model.brightness : 1);
    if (plan.isCensus && model.depth != CV_32F && model.white > model.black)
    {
        const double unit = LevelScale::end / (double)(1 << model.bits);
        levels.scale.black = cvRound(model.black * unit);
        levels.scale.white = std::max(cvRound(model.white * unit), levels.scale.black + 1);
    }
    levels.isGrey = model.isGrey;
    const int brightness = roundedBrightness(levels.scale.brightness);
    const double unit = greyScale * brightness;
    levels.leftBlocks.begin = blockStart(model.leftBlockStart - model.x + plan.extension);
    levels.leftBlocks.step = model.leftBlockStep * unit;
    levels.rightBlocks.begin = blockStart(model.rightBlockStart - model.x + moved);
    levels.rightBlocks.step = model.rightBlockStep * unit;

    // Where the matched image of the model begins: with another range it is moved by other columns.
    ImageFrame& frame = given.frame;
    frame.whole = Size(model.width + model.addedColumns, model.height);
    frame.origin = Point(model.x + model.addedColumns + model.minDisparity - moved, model.y);
    PairFindings& findings = given.findings;
    std::copy(model.rows.begin(), model.rows.end(), findings.rows.coefficients.val);
    findings.hasRows = model.areRowsMoved;
    std::copy(model.light.begin(), model.light.end(), findings.light.coefficients.val);
    findings.light = findings.light.scaled(brightness);
    findings.hasLight = model.isLightChanged;
    findings.rowError = model.rowError;
    findings.noise.deviation = model.noise * brightness;
    findings.noise.layer = model.noiseLayer;
    return given;
}

PairModel toPairModel(const PyramidPlan& plan, Size size, int depth, int numDisparities, const CompletePair& pair,
                      const LevelFindings& levels, const PairFindings& findings)
{
    PairModel model;
    const int brightness = roundedBrightness(levels.scale.brightness);
    const double unit = greyScale * brightness;
    const LightModel light = findings.light.scaled(1. / brightness);
    model.width = model.tileWidth = size.width;
    model.height = model.tileHeight = size.height;
    model.depth = depth;
    model.minDisparity = plan.minDisparity;
    model.numDisparities = numDisparities;
    model.addedColumns = plan.extension;
    model.rows.assign(findings.rows.coefficients.val, findings.rows.coefficients.val + RowModel::terms);
    model.areRowsMoved = findings.hasRows;
    model.light.assign(light.coefficients.val, light.coefficients.val + LightModel::terms);
    model.isLightChanged = findings.hasLight;
    model.rowError = findings.rowError;
    model.noise = findings.noise.deviation / brightness;
    model.noiseLayer = findings.noise.layer;
    model.black = depth == CV_32F ? pair.floats.black : levels.scale.darkest();
    model.white = depth == CV_32F ? pair.floats.white : levels.scale.darkest() + levels.scale.contrast();
    model.borderLevel = pair.borderLevel;
    model.bits = levels.scale.bits;
    model.brightness = levels.scale.brightness;
    model.isGrey = levels.isGrey;
    model.leftBlockStart = blockStart(levels.leftBlocks.begin - plan.extension);
    model.leftBlockStep = levels.leftBlocks.step / unit;
    model.rightBlockStart = blockStart(levels.rightBlocks.begin - plan.extension - plan.minDisparity);
    model.rightBlockStep = levels.rightBlocks.step / unit;
    return model;
}

} // namespace hdp

}} // namespace cv::stereo
