// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "test_precomp.hpp"
#include "helpers.hpp"
#include "synthetic_pair.hpp"

#include "../src/pair/image_levels.hpp"
#include "../src/pair/missing_pixels.hpp"
#include "../src/plan/pair_plan.hpp"

#include <fstream>

namespace opencv_test { namespace {

typedef HDPTreeMatcher M;

//! A pair with other rows, another light and some noise: all that there is to find, but for blocks
SyntheticPair makeMisalignedPair(Size size, int numDisparities, int seed)
{
    SyntheticPair pair = makeSyntheticPair(size, numDisparities, seed);
    Mat lower = pair.right.clone(), dark;
    pair.right.rowRange(0, size.height - 2).copyTo(lower.rowRange(2, size.height)); // rows are 2 pixels below
    lower.convertTo(dark, -1, 0.8, 6);
    pair.right = dark;
    return pair;
}

//! What a matcher found in a pair
PairModel modelOf(HDPTreeMatcher& matcher, const SyntheticPair& pair)
{
    matcher.setPairModel(PairModel());
    match(matcher, pair.left, pair.right);
    return matcher.getPairModel();
}

std::string textOf(const PairModel& model, const std::string& extension = "yml")
{
    FileStorage fs("." + extension, FileStorage::WRITE | FileStorage::MEMORY);
    fs << "pairModel"
       << "{";
    model.write(fs);
    fs << "}";
    return fs.releaseAndGetString();
}

PairModel readFrom(const std::string& text)
{
    FileStorage fs(text, FileStorage::READ | FileStorage::MEMORY);
    PairModel model;
    model.read(fs["pairModel"]);
    return model;
}

//! A model in which no value is a default one
PairModel makeUnusualModel()
{
    PairModel model;
    model.width = 1000;
    model.height = 800;
    model.depth = CV_16U;
    model.x = 64;
    model.y = 128;
    model.tileWidth = 500;
    model.tileHeight = 300;
    model.minDisparity = -20;
    model.numDisparities = 70;
    model.addedColumns = 20;
    for (size_t i = 0; i < model.rows.size(); ++i)
        model.rows[i] = 1. / 3 - (double)i;
    model.areRowsMoved = true;
    for (size_t i = 0; i < model.light.size(); ++i)
        model.light[i] = (double)i / 7;
    model.isLightChanged = true;
    model.rowError = 1. / 9;
    model.noise = 1. / 7;
    model.noiseLayer = 1;
    model.black = 1. / 3;
    model.white = 7.25;
    model.borderLevel = 17. / 3;
    model.bits = 12;
    model.brightness = 2.59375;
    model.isGrey = true;
    model.leftBlockStart = 3;
    model.leftBlockStep = 1. / 3;
    model.rightBlockStart = 5;
    model.rightBlockStep = 0.7;
    return model;
}

////////////////////////////////////////////// as the whole //////////////////////////////////////////////

TEST(HDPStereo_PairModel, the_pair_again)
{
    const SyntheticPair pair = makeMisalignedPair(Size(240, 180), 32, 4);
    for (const int preset :
         { +M::PRESET_PAPER, +M::PRESET_FAST, +M::PRESET_ULTRAFAST, +M::PRESET_QUALITY, +M::PRESET_TREE })
        for (const int minDisparity : { 0, -5 })
            for (const int depth : { CV_8U, CV_16U, CV_32F })
            {
                SCOPED_TRACE(format("preset %d, minDisparity %d, depth %d", preset, minDisparity, depth));
                Mat left = pair.left, right = pair.right;
                if (depth != CV_8U)
                    for (Mat* image : { &left, &right })
                    {
                        cvtColor(*image, *image, COLOR_BGR2GRAY);
                        image->convertTo(*image, depth, 3); // dark 10 bits
                    }
                const Ptr<HDPTreeMatcher> matcher = M::create(minDisparity, 32, preset);
                EXPECT_TRUE(matcher->getPairModel().empty());
                const Mat expected = match(*matcher, left, right);
                const PairModel model = matcher->getPairModel();
                const M::Findings found = matcher->getFindings();
                EXPECT_EQ(preset != M::PRESET_PAPER, model.areRowsMoved);
                EXPECT_EQ(depth == CV_8U ? 8 : depth == CV_16U ? 9 : 16, model.bits);
                EXPECT_LT(model.black, model.white);

                const Ptr<HDPTreeMatcher> other = M::create(minDisparity, 32, preset);
                other->setPairModel(readFrom(textOf(model)));
                expectIdentical(expected, match(*other, left, right));
                EXPECT_EQ(textOf(model), textOf(other->getPairModel()));
                const M::Findings given = other->getFindings();
                EXPECT_EQ(found.rows, given.rows);
                EXPECT_EQ(found.light, given.light);
                EXPECT_EQ(found.rowError, given.rowError);
                EXPECT_EQ(found.noise, given.noise);

                other->setPairModel(PairModel());
                expectIdentical(expected, match(*other, left, right));
            }
}

TEST(HDPStereo_PairModel, nothing_is_estimated)
{
    const SyntheticPair good = makeSyntheticPair(Size(240, 180), 32, 5),
                        bad = makeMisalignedPair(good.left.size(), 32, 5);
    const Ptr<HDPTreeMatcher> matcher = M::create(0, 32);
    const PairModel ofGood = modelOf(*matcher, good), ofBad = modelOf(*matcher, bad);
    EXPECT_FALSE(ofGood.areRowsMoved);
    EXPECT_TRUE(ofBad.areRowsMoved);

    // What is set is done, and nothing else.
    matcher->setPairModel(ofGood);
    const Mat unmoved = match(*matcher, bad.left, bad.right);
    EXPECT_FALSE(matcher->getFindings().areRowsMoved);
    matcher->setPairModel(PairModel());
    change(*matcher, [](Params& p) {
        p.maxRowOffset = 0;
        p.useLightAlignment = false;
    });
    matcher->setPairModel(ofBad);
    EXPECT_LT(badPixels(match(*matcher, bad.left, bad.right), bad.truth, bad.visible, 1),
              badPixels(unmoved, bad.truth, bad.visible, 1) / 2);
    EXPECT_TRUE(matcher->getFindings().areRowsMoved);
}

////////////////////////////////////////////// tiles //////////////////////////////////////////////

TEST(HDPStereo_PairModel, rows_and_light_of_a_tile)
{
    RNG rng(71);
    const Size size(331, 203);
    for (int round = 0; round < 20; ++round)
    {
        const Mat image = randomImage(rng, size, CV_16UC1, 1021);
        const Rect tile(rng.uniform(0, 200), rng.uniform(0, 100), 131, 103);
        hdp::RowModel rows;
        rows.coefficients = hdp::RowModel::Coefficients(rng.uniform(-4., 4.), rng.uniform(-0.01, 0.01),
                                                        rng.uniform(-0.01, 0.01), 1e-5, -1e-5);
        hdp::LightModel light;
        for (int i = 0; i < hdp::LightModel::terms; ++i)
            light.coefficients[i] += rng.uniform(-0.1, 0.1);
        Mat whole, part;
        hdp::alignRows(image, rows, hdp::ImageFrame(size), whole);
        hdp::alignLight(whole, light, hdp::ImageFrame(size));
        const hdp::ImageFrame frame(size, tile.tl());
        hdp::alignRows(image(tile).clone(), rows, frame, part);
        hdp::alignLight(part, light, frame);
        const Rect inside(0, 10, tile.width, tile.height - 20); // the rows beside are those of the tile's border
        expectIdentical(whole(inside + tile.tl()), part(inside));
    }
}

TEST(HDPStereo_PairModel, levels_of_a_tile)
{
    RNG rng(72);
    const Size size(328, 200);
    Mat left = patchyImage(rng, size, CV_8UC1, 8), right = patchyImage(rng, size, CV_8UC1, 8);
    for (const int minDisparity : { 0, -7, 5 })
    {
        const hdp::PyramidPlan plan = { minDisparity, minDisparity < 0 ? 8 : 0, 3, true, true, 0, false };
        hdp::PairPyramids pyramids, ofTile;
        std::vector<hdp::LayerImages> whole, part;
        PairModel model;
        {
            hdp::LevelFindings levels;
            levels.scale = hdp::LevelScale(8, 2.25);
            levels.scale.black = 1000;
            levels.scale.white = 50001;
            levels.leftBlocks.begin = 3;
            levels.rightBlocks.begin = 6;
            levels.leftBlocks.step = levels.rightBlocks.step = 5;
            hdp::buildPairPyramids(left, right, hdp::PairMasks(), plan, pyramids, whole, &levels);
            model = hdp::toPairModel(plan, size, CV_8U, 16, hdp::CompletePair(), levels, hdp::PairFindings());
        }
        const Rect tile(84, 40, 160, 120);
        const hdp::GivenPair given = hdp::toGivenPair(model.tile(tile), plan, tile.size());
        hdp::buildPairPyramids(left(tile), right(tile), hdp::PairMasks(), plan, ofTile, part, &given.levels);
        for (int layer = 0; layer < 3; ++layer)
        {
            const int margin = 24 >> layer; // for the blocks beside, and columns that are moved
            const Size area((tile.width >> layer) - 2 * margin, tile.height >> layer);
            const Rect inside(Point(margin, 0) + Point((plan.extension >> layer), 0), area);
            const Point offset(tile.x >> layer, tile.y >> layer);
            expectIdentical(whole[layer].left(inside + offset), part[layer].left(inside));
            expectIdentical(whole[layer].right(inside + offset), part[layer].right(inside));
            expectIdentical(whole[layer].guide(inside + offset), part[layer].guide(inside));
        }
    }
}

//! A model is about places in the right image, whatever range moves it.
//! A tile of floats has the levels of the whole, not of its own range.
TEST(HDPStereo_PairModel, floats_of_a_tile)
{
    const SyntheticPair pair = makeMisalignedPair(Size(240, 180), 32, 4);
    Mat floats[2];
    const Mat images[2] = { pair.left, pair.right };
    for (int i = 0; i < 2; ++i)
    {
        cvtColor(images[i], floats[i], COLOR_BGR2GRAY);
        floats[i].convertTo(floats[i], CV_32F, 1. / 7, -5);
    }
    const Ptr<HDPTreeMatcher> matcher = M::create(0, 32);
    match(*matcher, floats[0], floats[1]);
    PairModel model = matcher->getPairModel();
    hdp::CompletePair whole;
    hdp::completePair(floats[0], floats[1], Mat(), Mat(), PairModel(), whole);
    EXPECT_EQ(whole.floats.black, model.black);
    EXPECT_EQ(whole.floats.white, model.white);
    const Rect tile(48, 16, 100, 120);
    matcher->setPairModel(model.tile(tile));
    const Mat actual = match(*matcher, floats[0](tile), floats[1](tile)).clone();
    model.depth = CV_16U;
    model.black = model.white = 0; // levels are as they should be
    matcher->setPairModel(model.tile(tile));
    expectIdentical(match(*matcher, whole.left(tile), whole.right(tile)), actual);
}

TEST(HDPStereo_PairModel, another_range)
{
    RNG rng(73);
    const Size size(200, 120);
    const Mat right = randomImage(rng, size, CV_16UC1, 1021);
    PairModel model;
    model.width = model.tileWidth = size.width;
    model.height = model.tileHeight = size.height;
    model.rows = { 1.5, 0.01, -0.02, 0, 0 };
    model.areRowsMoved = model.isLightChanged = true;
    model.light[1] = 0.3;
    const auto align = [&](int minDisparity, int extension) {
        const hdp::PyramidPlan plan = { minDisparity, extension, 1, true, false, 0, false };
        Mat memory;
        const Mat shifted = hdp::shiftColumns(right, minDisparity, extension, memory);
        const hdp::GivenPair given = hdp::toGivenPair(model, plan, size);
        Mat aligned;
        hdp::alignRows(shifted, given.findings.rows, given.frame, aligned);
        hdp::alignLight(aligned, given.findings.light, given.frame);
        return aligned;
    };
    const Mat unmoved = align(0, 0);
    expectIdentical(unmoved.colRange(0, size.width - 9), align(9, 0).colRange(9, size.width));
    expectIdentical(unmoved.colRange(0, size.width), align(-20, 32).colRange(12, size.width + 12));
}

TEST(HDPStereo_PairModel, enlarged)
{
    RNG rng(74);
    PairModel model;
    model.width = model.tileWidth = 100;
    model.height = model.tileHeight = 60;
    model.numDisparities = 16;
    for (double& coefficient : model.rows)
        coefficient = rng.uniform(-1., 1.);
    model.rowError = 0.1;
    const PairModel large = model.enlarged(2, 403, 240);
    EXPECT_DOUBLE_EQ(0.4, large.rowError);
    EXPECT_EQ(Size(403, 240), Size(large.tileWidth, large.tileHeight));
    hdp::RowModel small, enlarged;
    std::copy(model.rows.begin(), model.rows.end(), small.coefficients.val);
    std::copy(large.rows.begin(), large.rows.end(), enlarged.coefficients.val);
    for (int round = 0; round < 20; ++round)
    {
        const Point2d place(rng.uniform(-50., 50.), rng.uniform(-30., 30.));
        EXPECT_NEAR(4 * small.at(place), enlarged.at(4 * place), 1e-9);
    }
    expectRejected([&] { model.enlarged(2, 404, 240); }, "width");
    expectRejected([&] { model.enlarged(16, 100 << 16, 60 << 16); }, "times");
    expectRejected([&] { model.tile(0, 0, 50, 50).enlarged(1, 200, 120); }, "whole images");
    model.rows.clear();
    expectRejected([&] { model.enlarged(2, 403, 240); }, "rows must be 5 finite numbers");
}

//! Share of the pixels that tiles with a margin have otherwise than the whole, by more than a limit in pixels
double differentShare(const SyntheticPair& pair, int preset, int numDisparities, int margin, double limit)
{
    const Ptr<HDPTreeMatcher> matcher = M::create(0, numDisparities, preset);
    const Mat whole = match(*matcher, pair.left, pair.right);
    const PairModel model = matcher->getPairModel();
    const Rect all(Point(), pair.left.size());
    const int core = 192, step = 48; // the step is that of all grids in three layers
    const auto toGrid = [=](int pixels) { return (pixels + step - 1) / step * step; };
    double different = 0;
    for (int y = 0; y < all.height; y += core)
        for (int x = 0; x < all.width; x += core)
        {
            const Rect inside = Rect(x, y, core, core) & all;
            const int before = toGrid(numDisparities + margin), above = toGrid(margin);
            const Rect tile = Rect(x - before, y - above, before + core + margin, above + core + margin) & all;
            matcher->setPairModel(model.tile(tile));
            const Mat part = match(*matcher, pair.left(tile), pair.right(tile));
            different += cv::countNonZero(cv::abs(whole(inside) - part(inside - tile.tl())) > 16 * limit);
        }
    return different / all.area();
}

//! Where there is texture, but for a few pixels' fractions: one pixel of the layer above that differs changes the weight
//! of smoothness around it a little. Surfaces without texture have what scanlines and trees carry there from any distance,
//! and what the surfaces are that are around a pixel.
TEST(HDPStereo_SlowPairModel, tiles_are_parts_of_the_whole)
{
    const Size size(768, 576);
    const SyntheticPair plane = makeSlantedPlane(size, 48, 6);
    EXPECT_LE(differentShare(plane, M::PRESET_QUALITY, 48, 64, 0), 0.002);
    EXPECT_LE(differentShare(plane, M::PRESET_FAST, 48, 64, 0), 0.002);
    EXPECT_EQ(0, differentShare(plane, M::PRESET_QUALITY, 48, 64, 0.25));
    double fractions = 0, pixels = 0;
    for (int seed = 3; seed <= 6; ++seed)
    {
        const SyntheticPair pair = makeMisalignedPair(size, 48, seed);
        fractions += differentShare(pair, M::PRESET_FAST, 48, 128, 0) / 4;
        pixels += differentShare(pair, M::PRESET_FAST, 48, 128, 1) / 4;
    }
    EXPECT_LE(fractions, 0.016);
    EXPECT_LE(pixels, 0.0005);
}

////////////////////////////////////////////// files and errors //////////////////////////////////////////////

TEST(HDPStereo_PairModel, files)
{
    const PairModel model = makeUnusualModel();
    for (const char* extension : { "yml", "xml", "json" })
    {
        EXPECT_EQ(textOf(model), textOf(readFrom(textOf(model, extension)))) << extension;
        const TemporaryFile file(format(".%s", extension).c_str());
        model.save(file.name);
        EXPECT_EQ(textOf(model), textOf(PairModel::load(file.name)));
    }
    expectRejected([] { PairModel::load("no such file.yml"); }, "no such file.yml");
    expectRejected([&] { model.save("no such folder/model.yml"); }, "no such folder");
    const TemporaryFile other(".yml");
    for (const char* text : { "pairModel: [ 1", "%YAML:1.0\n---\nother: 1\n", "%YAML:1.0\n---\n- 1\n",
                              "%YAML:1.0\n---\npairModel: { width: 1 }\n" })
    {
        std::ofstream(other.name.c_str()) << text;
        expectRejected([&] { PairModel::load(other.name); }, other.name);
    }

    std::ofstream(other.name.c_str()) << "%YAML:1.0\n---\nother: 1\n";
    const FileStorage fs(other.name, FileStorage::READ);
    PairModel unchanged = model;
    expectRejected([&] { unchanged.read(fs["other"]); }, "must be a map");
    EXPECT_EQ(textOf(model), textOf(unchanged));

    // Every field is needed.
    const std::string text = textOf(model);
    std::istringstream lines(text);
    int fields = 0;
    for (std::string line; std::getline(lines, line);)
    {
        const size_t colon = line.find(':');
        if (line.compare(0, 3, "   ") != 0 || line[3] == ' ' || colon == std::string::npos)
            continue;
        const std::string name = line.substr(3, colon - 3);
        std::string without = text;
        without.replace(without.find("   " + name + ":") + 3, 1, "_");
        expectRejected([&] { readFrom(without); }, name);
        ++fields;
    }
    EXPECT_EQ(27, fields);
}

TEST(HDPStereo_PairModel, bad_values)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::pair<const char*, std::function<void(PairModel&)>>> changes = {
        { "width", [](PairModel& m) { m.width = -1; } },
        { "height", [](PairModel& m) { m.height = 0; } },
        { "depth", [](PairModel& m) { m.depth = CV_32S; } },
        { "tileWidth", [](PairModel& m) { m.tileWidth = 0; } },
        { "tileHeight", [](PairModel& m) { m.tileHeight = m.height + 1; } },
        { "x", [](PairModel& m) { m.x = m.width - m.tileWidth + 1; } },
        { "y", [](PairModel& m) { m.y = -1; } },
        { "numDisparities", [](PairModel& m) { m.numDisparities = 0; } },
        { "addedColumns", [](PairModel& m) { m.addedColumns = -1; } },
        { "rows", [=](PairModel& m) { m.rows[4] = nan; } },
        { "rows", [](PairModel& m) { m.rows.pop_back(); } },
        { "rows", [](PairModel& m) { m.rows[1] = 8589934591.999998; } },
        { "rows", [](PairModel& m) { m.rows[4] = -1e300; } },
        { "rows", [](PairModel& m) { m.rows[1] = 2; m.minDisparity = -(1 << 24); } },
        { "light", [=](PairModel& m) { m.light[9] = nan; } },
        { "light", [](PairModel& m) { m.light[0] = -2e6; } },
        { "light", [](PairModel& m) { m.light.push_back(0); } },
        { "rowError", [](PairModel& m) { m.rowError = -1; } },
        { "rowError", [=](PairModel& m) { m.rowError = nan; } },
        { "noise", [](PairModel& m) { m.noise = -1; } },
        { "noise", [](PairModel& m) { m.noise = 1e9; } },
        { "noiseLayer", [](PairModel& m) { m.noiseLayer = 16; } },
        { "black", [=](PairModel& m) { m.black = nan; } },
        { "black", [](PairModel& m) { m.black = -1; } },
        { "white", [](PairModel& m) { m.white = 65537; } },
        { "white", [](PairModel& m) { m.white = m.black - 1; } },
        { "bits", [](PairModel& m) { m.bits = 17; } },
        { "bits", [](PairModel& m) { m.depth = CV_8U; } },
        { "brightness", [](PairModel& m) { m.brightness = 4.5; } },
        { "brightness", [=](PairModel& m) { m.brightness = nan; } },
        { "leftBlockStart", [](PairModel& m) { m.leftBlockStart = 8; } },
        { "leftBlockStep", [=](PairModel& m) { m.leftBlockStep = nan; } },
        { "rightBlockStart", [](PairModel& m) { m.rightBlockStart = -1; } },
        { "rightBlockStep", [](PairModel& m) { m.rightBlockStep = -1; } },
    };
    const Ptr<HDPTreeMatcher> matcher = M::create(0, 16);
    for (const auto& bad : changes)
    {
        PairModel model = makeUnusualModel();
        bad.second(model);
        expectRejected([&] { matcher->setPairModel(model); }, std::string("PairModel: ") + bad.first);
        expectRejected([&] { textOf(model); }, bad.first);
    }
    const std::string text = textOf(makeUnusualModel());
    for (const char* line : { "   width: -3", "   bits: 17", "   rowError: .Nan", "   black: .Inf" })
    {
        const std::string field(line, std::strchr(line, ':') + 1);
        std::string spoilt = text;
        const size_t begin = spoilt.find(field);
        spoilt.replace(begin, spoilt.find('\n', begin) - begin, line);
        expectRejected([&] { readFrom(spoilt); }, field.substr(3, field.size() - 4));
    }
    // What is not written harms no file.
    const TemporaryFile file(".yml");
    PairModel model = makeUnusualModel();
    model.save(file.name);
    model.rowError = nan;
    expectRejected([&] { model.save(file.name); }, "PairModel: rowError");
    EXPECT_EQ(text, textOf(PairModel::load(file.name)));
    EXPECT_TRUE(readFrom(textOf(PairModel())).empty());
    expectRejected([] { PairModel().tile(0, 0, 1, 1); }, "empty");
    expectRejected([] { makeUnusualModel().tile(501, 0, 500, 1); }, "PairModel: x");
}

TEST(HDPStereo_PairModel, other_images)
{
    const SyntheticPair pair = makeSyntheticPair(Size(120, 96), 16, 7);
    const Ptr<HDPTreeMatcher> matcher = M::create(0, 16);
    const PairModel model = modelOf(*matcher, pair);
    const Mat expected = match(*matcher, pair.left, pair.right);
    Mat deep[2], disparity = expected.clone();
    for (int i = 0; i < 2; ++i)
    {
        cvtColor(i == 0 ? pair.left : pair.right, deep[i], COLOR_BGR2GRAY);
        deep[i].convertTo(deep[i], CV_16U);
    }
    const auto compute = [&](const PairModel& given, const Mat& left, const Mat& right) {
        matcher->setPairModel(given);
        matcher->compute(left, right, disparity);
    };
    const Rect part(1, 2, 64, 64);
    expectRejected([&] { compute(model, deep[0], deep[1]); }, "left must have 8 bits");
    expectRejected([&] { compute(model, pair.left(part), pair.right(part)); }, "left must have 120 x 96 pixels");
    expectRejected([&] { compute(model.tile(part), pair.left, pair.right); }, "left must have 64 x 64 pixels");
    expectRejected([&] { compute(model.tile(part), pair.left(part), pair.right(part)); }, "multiples of");
    const Rect small(4, 4, 20, 1);
    expectRejected([&] { compute(model.tile(small), pair.left(small), pair.right(small)); }, "left must have");
    expectIdentical(expected, disparity);
    EXPECT_TRUE(matcher->getPairModel().empty()) << "after an exception";
    for (Mat& image : deep)
        image.convertTo(image, CV_32F);
    expectRejected([&] { compute(model, deep[0], deep[1]); }, "left must have 8 bits");
    compute(PairModel(), deep[0], deep[1]);
    const PairModel ofFloats = matcher->getPairModel();
    expectRejected([&] { compute(ofFloats, pair.left, pair.right); }, "left must have levels of CV_32F");
    matcher->setPairModel(PairModel());
    expectIdentical(expected, match(*matcher, pair.left, pair.right));
}

}} // namespace opencv_test
