// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The programs that evaluate matchers: exit status, and what they print and write.

#include "test_precomp.hpp"
#include "programs.hpp"
#include "synthetic_video.hpp"

#ifdef __unix__
#include <cstdio>
#include <unistd.h>

namespace opencv_test { namespace {

//! Names that an option does not know are errors that name them.
void testUnknown(const DatasetFolder& folder, const String& command, const String& option, const String& kind,
                 const std::vector<String>& names)
{
    for (const String& name : names)
    {
        const Execution wrong = run(folder, command + " " + option + "=" + name);
        EXPECT_EQ(1, wrong.status) << name;
        EXPECT_EQ(0u, wrong.errors.find("error: " + option + " knows no " + kind + " '" + name + "'")) << wrong.errors;
    }
}

TEST(HDPStereo_EvaluationPrograms, help_and_wrong_arguments)
{
    for (const char* program : { "hdp_evaluate", "hdp_benchmark", "hdp_train", "hdp_parameters", "hdp_pictures",
                                 "hdp_robustness", "hdp_stability", "hdp_video" })
        testHelpAndWrongArguments(program);
}

#ifdef __linux__
//! Tables that are lost on a full disk are an error.
TEST(HDPStereo_EvaluationPrograms, full_disk)
{
    const DatasetFolder folder;
    writePair(folder);
    const String pair = pairOf(folder), truth = " --truth=" + folder.path("dataset/a/disp_left.png"),
                 dataset = " " + folder.path("dataset");
    for (const String& command :
         { "hdp_evaluate --help" + String(), "hdp_evaluate --methods=fast,bm" + dataset,
           "hdp_benchmark --methods=fast --runs=1" + pair, "hdp_benchmark --memory-of=fast" + pair,
           "hdp_train --layers=2 --max-components=1" + dataset + " -o " + folder.path("model.yml"),
           "hdp_robustness --methods=fast --cases=clean" + dataset, "hdp_parameters --presets=fast --runs=1" + dataset,
           "hdp_video --methods=fast --noise=0 --still=2" + dataset,
           "hdp_stability --methods=fast --changes=flip" + dataset,
           "hdp_pictures --output=" + folder.root + pair + truth })
    {
        SCOPED_TRACE(command);
        EXPECT_EQ(1, run(folder, command, "/dev/full").status);
    }
}
#endif

TEST(HDPStereo_EvaluationPrograms, subpixel)
{
    const DatasetFolder folder;
    EXPECT_EQ(0, run(folder, "hdp_subpixel --help").status);
    const Execution good = run(folder, "hdp_subpixel --methods=fast,sgbm --textures=natural");
    EXPECT_EQ(0, good.status) << good.errors;
    for (const char* row : { "### natural texture, noise 2", "| fast |", "| sgbm |" })
        EXPECT_NE(String::npos, good.output.find(row)) << row;
    for (const char* bad : { "--textures=rough", "--textures=,", "--noise=-1", "--methods=slow", "file.png" })
    {
        const Execution wrong = run(folder, "hdp_subpixel " + String(bad));
        EXPECT_EQ(1, wrong.status) << bad;
        EXPECT_EQ(0u, wrong.errors.find("error: ")) << wrong.errors;
    }
}

TEST(HDPStereo_EvaluationPrograms, robustness)
{
    const DatasetFolder folder;
    writePair(folder);
    const String common = "hdp_robustness --num-disparities=32 " + folder.path("dataset") + " --methods=fast,sgbm-hh4";
    const Execution good =
        run(folder, common + " --cases=clean,dy3,gain.5,noise4,defects1,linear,jpeg40,borders8,shear");
    EXPECT_EQ(0, good.status) << good.errors;
    for (const char* row : { "means of 3 pairs", "| case | fast | sgbm-hh4 |", "| clean |", "| dy3 |", "| gain.5 |",
                             "| noise4 |", "| defects1 |", "| linear |", "| jpeg40 |", "| borders8 |", "| shear |" })
        EXPECT_NE(String::npos, good.output.find(row)) << row;
    const auto shearOf = [&](const String& cases) { // the figures of a case do not depend on those before it
        const String output = run(folder, common + " --cases=" + cases).output;
        const size_t begin = output.find("| shear |");
        return begin == String::npos ? String() : output.substr(begin, output.find('\n', begin) - begin);
    };
    EXPECT_EQ(shearOf("shear"), shearOf("borders8,shear"));
    EXPECT_NE(String(), shearOf("shear"));
    testUnknown(folder, common, "--cases", "case", { "dy", "dy1x", "clean2", "rain" });
    for (const char* name : { "blur0", "blur99999", "jpeg101", "noise-1", "dy1e99" })
        EXPECT_NE(String::npos, run(folder, common + " --cases=" + name)
                                    .errors.find("error: --cases: the number of '" + String(name) + "' must be "))
            << name;
    EXPECT_EQ("error: --cases=, names nothing\n", run(folder, common + " --cases=,").errors);
    folder.write("dataset/b/left.png", Mat(10, 10, CV_8UC3, Scalar::all(0))); // of another size than the right one
    const Execution two = run(folder, common + " --cases=clean");
    EXPECT_EQ(2, two.status);
    EXPECT_NE(String::npos, two.errors.find("1 of 3 pairs were skipped")) << two.errors;
}

TEST(HDPStereo_EvaluationPrograms, truth_of_two_kinds_has_no_mean)
{
    const DatasetFolder folder;
    writePair(folder); // KITTI's
    Mat truth(240, 320, CV_32F, Scalar(9)), image(240, 320, CV_8UC3);
    cvtest::randUni(theRNG(), image, Scalar::all(0), Scalar::all(256));
    for (const char* name : { "left.png", "right.png" })
        folder.write(String("dataset/d/") + name, image);
    for (const char* name : { "disp_left.pfm", "disp_right.pfm" })
        folder.write(String("dataset/d/") + name, truth);
    for (const char* program :
         { "hdp_robustness --cases=clean --methods=bm ", "hdp_parameters --runs=1 --presets=fast " })
    {
        const Execution mixed = run(folder, program + folder.path("dataset"));
        EXPECT_EQ(2, mixed.status) << program;
        EXPECT_NE(String::npos, mixed.errors.find("skipped dataset/d: its truth is of another kind")) << mixed.errors;
    }
}

TEST(HDPStereo_EvaluationPrograms, stability)
{
    const DatasetFolder folder;
    writePair(folder);
    for (const char* side : { "left.png", "right.png" })
        folder.write(String("others/street/") + side, cv::imread(folder.path("dataset/a/") + side));
    const String common = "hdp_stability --num-disparities=32 --methods=fast,bm " + folder.root;
    const Execution good = run(folder, common + " --confidence");
    EXPECT_EQ(0, good.status) << good.errors;
    for (const char* row :
         { "### Stability of dataset, means of 3 pairs", "### Stability of others, means of 1 pairs",
           "### D1 of dataset, means of 3 pairs", "\n| fast | - | - | - | - | ", "| change | fast | bm |",
           "| noise.5 | ", "| gamma.95 | ", "| left8 | ", "| top1 | ", "| mirror | ", "| scale.98 | ", "| bits12 | ",
           "### Confidence and stability of dataset", "\n| bm | - | - | - | - |\n" })
        EXPECT_NE(String::npos, good.output.find(row)) << row << good.output;
    EXPECT_EQ(good.output, run(folder, common + " --confidence --threads=1").output);
    const Execution few = run(folder, common + " --changes=top3,clean --scenes=a");
    EXPECT_EQ(0, few.status) << few.errors;
    EXPECT_NE(String::npos, few.output.find("| clean | **0.00** | **0.00** |")) << few.output;
    testUnknown(folder, common, "--changes", "change", { "left", "left1.5", "jpeg0", "flip2", "rain", "noise" });
    const Execution nothing = run(folder, common + " --changes=left159 --scenes=a");
    EXPECT_EQ(2, nothing.status);
    EXPECT_NE(String::npos, nothing.errors.find("the change left159 leaves no pixel that can be judged"))
        << nothing.errors;
    folder.write("dataset/b/left.png", Mat(10, 10, CV_8UC3, Scalar::all(0))); // of another size than the right one
    EXPECT_EQ(2, run(folder, common + " --changes=flip").status);
}

//! The mean over changes is that of runs with one change each.
TEST(HDPStereo_EvaluationPrograms, means_over_changes)
{
    const DatasetFolder folder;
    writePair(folder);
    const String common = "hdp_evaluate --num-disparities=32 " + folder.path("dataset") + " --methods=fast ";
    const auto errorOf = [&](const String& changes) {
        const Execution result = run(folder, common + changes + " --csv=" + folder.path("tables.csv"));
        EXPECT_EQ(0, result.status) << result.errors;
        const String csv = readText(folder.path("tables.csv"));
        const size_t row = csv.find("\ndataset,a,fast,");
        return row == String::npos ? -1. : std::stod(csv.substr(row + 16)); // err>=1
    };
    const double clean = errorOf(""), noise = errorOf("--changes=noise4"), flip = errorOf("--changes=flip");
    EXPECT_GT(noise, clean);
    EXPECT_EQ(clean, errorOf("--changes=clean"));
    EXPECT_NEAR((noise + flip) / 2, errorOf("--changes=noise4,flip"), 1e-4);

    const String shown = " --maps=" + folder.path("maps") + " --report=" + folder.path("report");
    const Execution all = run(folder, common + "--changes --scenes=b" + shown);
    EXPECT_EQ(0, all.status) << all.errors;
    EXPECT_EQ(0u, all.output.find("Means over the changes noise.5, ")) << all.output;
    const String changed = readText(folder.path("maps/fast/dataset/b.png"));
    EXPECT_EQ(0, run(folder, common + "--scenes=b" + shown).status);
    EXPECT_TRUE(changed == readText(folder.path("maps/fast/dataset/b.png"))); // of the pair as it is
    EXPECT_EQ(1, run(folder, common + "--changes=rain").status);

    const Execution parameters =
        run(folder, "hdp_parameters --runs=1 --presets=fast --changes=left2,mirror " + folder.path("dataset"));
    EXPECT_EQ(0, parameters.status) << parameters.errors;
    EXPECT_NE(String::npos,
              parameters.output.find("| dataset: PRESET_FAST with | average error, pixels | D1 % | time |"));
    EXPECT_NE(String::npos, parameters.output.find("| blockSize = 5 | "));
    EXPECT_EQ("error: --presets=, names nothing\n",
              run(folder, "hdp_parameters --presets=, " + folder.path("dataset")).errors);
    EXPECT_EQ("error: a folder is needed, see --help\n", run(folder, "hdp_parameters").errors);
    std::remove(folder.path("dataset/b/right.png").c_str());
    const Execution two = run(folder, "hdp_parameters --runs=1 --presets=fast " + folder.path("dataset"));
    EXPECT_EQ(2, two.status);
    EXPECT_NE(String::npos, two.errors.find("skipped dataset/b: ")) << two.errors;
    EXPECT_NE(String::npos, two.output.find("| blockSize = 5 | "));
}

TEST(HDPStereo_EvaluationPrograms, video)
{
    const DatasetFolder folder;
    SyntheticVideo video(Size(160, 120), 8, 3);
    for (int i = 0; i < 4; ++i)
    {
        const SyntheticFrame frame = video.render(i, std::vector<Board>(), Point3d(0.2 * i, 0, 0));
        const String name = format("/%03d.png", i);
        for (const String root : { "videos/known", "videos/unknown" })
        {
            folder.write(root + "/left" + name, frame.left);
            folder.write(root + "/right" + name, frame.right);
        }
        Mat truth;
        frame.truth.convertTo(truth, CV_16U, 256);
        folder.write("videos/known/disp_lidar" + name, truth);
    }
    const String common =
        "hdp_video " + folder.path("videos") + " --num-disparities=32 --methods=fast,bm,sgbm-3way --noise=0,2.5";
    const Execution all = run(folder, common + " --runs=2");
    EXPECT_EQ(0, all.status) << all.errors;
    for (const char* row : { "### known: the last 2 of 4 frames", "### unknown: ", "\n| fast | 0 | ", "\n| bm | 2.5 | ",
                             "\n| fast | 2.5 | - | - |" })
        EXPECT_NE(String::npos, all.output.find(row)) << row << all.output;

    // A scene that stands still: errors and flicker are fewer.
    const Execution still = run(folder, "hdp_video " + folder.path("videos/known") +
                                            " --num-disparities=32 --methods=fast --noise=6 --still=8");
    EXPECT_EQ(0, still.status) << still.errors;
    double d1[2], flicker[2];
    const size_t at = still.output.find("| fast | 6 |");
    ASSERT_NE(String::npos, at) << still.output;
    ASSERT_EQ(4, std::sscanf(still.output.c_str() + at, "| fast | 6 | %lf | %lf | %lf | %lf |", &d1[0], &d1[1],
                             &flicker[0], &flicker[1]));
    EXPECT_LE(d1[1], d1[0]);
    EXPECT_LT(flicker[1], 0.5 * flicker[0]);

    // Pairs that a camera pans over: their truth is that of each frame.
    const Execution pans = run(folder, "hdp_video " + folder.path("videos/known") +
                                           " --num-disparities=32 --methods=fast,bm --noise=2 --pan=-3,1 --still=6");
    EXPECT_EQ(0, pans.status) << pans.errors;
    EXPECT_NE(String::npos, pans.output.find("### known: pans over 4 pairs, the last 3 of 6 frames")) << pans.output;
    const size_t panned = pans.output.find("| fast | 2 |");
    ASSERT_NE(String::npos, panned) << pans.output;
    ASSERT_EQ(2, std::sscanf(pans.output.c_str() + panned, "| fast | 2 | %lf | %lf |", &d1[0], &d1[1])) << pans.output;
    EXPECT_LT(d1[0], 10);
    EXPECT_LE(d1[1], 1.1 * d1[0]);
    EXPECT_EQ(2, run(folder, "hdp_video " + folder.path("videos/known") + " --pan=90,0").status)
        << "no picture is left";
    std::remove(folder.path("videos/known/disp_lidar/001.png").c_str());
    const Execution partly = run(folder, "hdp_video " + folder.path("videos/known") +
                                             " --num-disparities=32 --methods=fast --noise=2 --pan=-3,1 --still=2");
    EXPECT_EQ(0, partly.status) << partly.errors;

    const Execution some =
        run(folder, "hdp_video " + folder.path("videos/known") +
                        " --num-disparities=32 --methods=fast,bm --colors --variants=every2,foreign");
    EXPECT_EQ(0, some.status) << some.errors;
    for (const char* row : { "### known: variants of 4 frames", "\n| every2 | fast | ", "\n| foreign | bm | " })
        EXPECT_NE(String::npos, some.output.find(row)) << row << some.output;
    const Execution variants =
        run(folder, "hdp_video " + folder.path("videos/unknown") + " --num-disparities=32 --methods=fast --variants");
    EXPECT_EQ(0, variants.status) << variants.errors;
    for (const char* name : { "recorded", "random", "three-times", "exposure.7", "fade", "noise15", "rows3" })
        EXPECT_NE(String::npos, variants.output.find(format("\n| %s | fast | - | - | ", name))) << variants.output;

    for (const char* bad : { "--noise=x", "--noise=-1", "--still=1", "--variants=rain", "--variants --still=9", "--pan",
                             "--pan=3", "--pan=3,x", "--pan=3,1 --variants", "--variants --noise=5", "--variants=," })
        EXPECT_EQ(1, run(folder, "hdp_video " + folder.path("videos") + " " + bad).status) << bad;
    folder.write("videos/unknown/left/002.png", Mat(10, 10, CV_8U, Scalar(0)));
    const Execution skipped = run(folder, common);
    EXPECT_EQ(2, skipped.status);
    EXPECT_NE(String::npos, skipped.errors.find("skipped unknown: ")) << skipped.errors;
}

TEST(HDPStereo_EvaluationPrograms, evaluate)
{
    const DatasetFolder folder;
    writePair(folder);
    const String common = "hdp_evaluate --num-disparities=32 " + folder.path("dataset") +
                          " --methods=fast,opencv,paper,mst --csv=" + folder.path("tables.csv") +
                          " --report=" + folder.path("report") + " --maps=" + folder.path("maps");
    const Execution all = run(folder, common + " --jobs=2");
    EXPECT_EQ(0, all.status) << all.errors;
    EXPECT_NE(String::npos, all.output.find("| scene | fast | bm | sgbm | sgbm-3way | sgbm-hh4 | paper | mst |"));
    EXPECT_NE(String::npos, all.output.find("| mean of 3 |"));
    EXPECT_NE(String::npos, readText(folder.path("tables.csv")).find("dataset,b,sgbm-3way,"));
    const String page = readText(folder.path("report/index.html"));
    EXPECT_NE(String::npos, page.find("Table 1"));
    EXPECT_NE(String::npos, page.find("data:image/jpeg"));
    EXPECT_EQ(Size(160, 120), cv::imread(folder.path("maps/fast/dataset/b.png"), IMREAD_UNCHANGED).size());

    const Execution confidence =
        run(folder, "hdp_evaluate --num-disparities=32 --methods=fast --confidence " + folder.path("dataset"));
    EXPECT_EQ(0, confidence.status) << confidence.errors;
    for (const char* row : { "| confidence >= | dataset: pixels | dataset: wrong |", "\n| 0 | 100.0 | ", "\n| 200 | " })
        EXPECT_NE(String::npos, confidence.output.find(row)) << confidence.output;
    const Execution both = run(folder, "hdp_evaluate --num-disparities=32 --confidence --calibration --methods=fast " +
                                           folder.path("dataset"));
    EXPECT_EQ(0, both.status) << both.errors;
    EXPECT_NE(String::npos, both.output.find("| sigma, pixels | dataset |"));
    EXPECT_NE(String::npos, both.output.find(confidence.output));
    EXPECT_EQ(0, run(folder, "hdp_evaluate --num-disparities=32 --confidence " + folder.path("dataset")).status);
    EXPECT_EQ("error: --confidence: bm knows no errors\n",
              run(folder, "hdp_evaluate --methods=bm --confidence " + folder.path("dataset")).errors);

    for (const String other : { "--changes", "--csv=x.csv", "--report=x", "--maps=x" })
        for (const String mode : { "--confidence", "--calibration", "--num-disparities=0" })
            EXPECT_EQ("error: " + other.substr(0, other.find('=')) + " does not go with " + mode + "\n",
                      run(folder, "hdp_evaluate " + folder.path("dataset") + " " + other + " " + mode).errors);
    EXPECT_EQ("error: --confidence does not go with --num-disparities=0\n",
              run(folder, "hdp_evaluate --confidence --num-disparities=0 " + folder.path("dataset")).errors);
    EXPECT_EQ("error: --runs and --jobs do not go with --confidence\n",
              run(folder, "hdp_evaluate --confidence --runs=2 " + folder.path("dataset")).errors);

    // A pair that cannot be read is named and left out.
    std::remove(folder.path("dataset/b/right.png").c_str());
    for (const String mode : { "--confidence", "--calibration", "--num-disparities=0" })
    {
        const Execution partial =
            run(folder, "hdp_evaluate --methods=fast,tree " + folder.path("dataset") + " " + mode);
        EXPECT_EQ(2, partial.status) << partial.errors;
        EXPECT_NE(String::npos, partial.errors.find("skipped dataset/b fast: cannot read ")) << partial.errors;
        EXPECT_NE(String::npos, partial.errors.find("1 of 3 pairs were skipped")) << partial.errors;
        EXPECT_NE(String::npos, partial.output.find(", tree\n")) << partial.output;
        for (const String side : { "left.png", "right.png" })
            folder.write("unknown/a/" + side, cv::imread(folder.path("dataset/a/" + side)));
        EXPECT_EQ("error: no pair has truth, which " + mode + " needs\n",
                  run(folder, "hdp_evaluate " + folder.path("unknown") + " " + mode).errors);
    }
    const Execution two = run(folder, common);
    EXPECT_EQ(2, two.status);
    EXPECT_NE(String::npos, two.errors.find("skipped dataset/b"));
    EXPECT_NE(String::npos, two.output.find("| mean of 2 |"));

    for (const String options :
         { "--confidence", "--calibration --methods=fast,tree", "--calibration --num-disparities=0" })
        EXPECT_EQ(
            "error: --plot needs --calibration, one method and no --num-disparities=0\n",
            run(folder, "hdp_evaluate --methods=fast --plot=x.svg " + options + " " + folder.path("dataset")).errors)
            << options;
    const Execution unknown = run(folder, "hdp_evaluate --methods=FAST " + folder.path("dataset"));
    EXPECT_EQ(1, unknown.status);
    EXPECT_NE(String::npos, unknown.errors.find("'FAST' is unknown, there are: "));
}

//! The same names of methods, and the same errors, as those of hdp_evaluate
TEST(HDPStereo_EvaluationPrograms, benchmark)
{
    const DatasetFolder folder;
    writePair(folder);
    const Execution result = run(folder, "hdp_benchmark --methods=fast,sgbm-3way --runs=2 --stages" + pairOf(folder) +
                                             " --truth=" + folder.path("dataset/a/disp_left.png"));
    EXPECT_EQ(0, result.status) << result.errors;
    for (const char* row : { "\n| fast | ", "\n| sgbm-3way | ", "\n| fast | image pyramid | " })
        EXPECT_NE(String::npos, result.output.find(row)) << result.output;
    EXPECT_EQ(1, run(folder, "hdp_benchmark --methods=none" + pairOf(folder)).status);

    const String sizes = "hdp_benchmark --methods=fast,sgbm-3way --runs=1" + pairOf(folder) + " --sizes";
    const Execution listed = run(folder, sizes + "=120x90/16,80x60/32");
    EXPECT_EQ(0, listed.status) << listed.errors;
    for (const char* row :
         { "| fast | sgbm-3way |", "\n| 160 x 120, 32 | ", "\n| 120 x 90, 16 | ", "\n| 80 x 60, 32 | ", ", 1.00 x |" })
        EXPECT_NE(String::npos, listed.output.find(row)) << listed.output;
    for (const char* wrong : { "=120x90", "=120x90/", "=120x90/17", "=120/16", "=x/16", "=120x90/16x" })
        EXPECT_EQ(1, run(folder, sizes + wrong).status) << wrong;
}

TEST(HDPStereo_EvaluationPrograms, train_then_evaluate)
{
    const DatasetFolder folder;
    writePair(folder);
    const String model = folder.path("model.yml"), dataset = folder.path("dataset");
    const Execution trained = run(folder, "hdp_train " + dataset + " --fraction=0.7 --max-components=1 -o " + model);
    EXPECT_EQ(0, trained.status) << trained.errors;
    EXPECT_NE(String::npos, trained.output.find("held out"));
    EXPECT_EQ(0, run(folder, "hdp_evaluate " + dataset + " --methods=paper --model=" + model).status);
    const Execution many = run(folder, "hdp_train " + dataset + " --layers=5 --max-components=1 -o " + model);
    EXPECT_EQ(0, many.status) << many.errors;
    EXPECT_NE(String::npos, many.output.find("no table of errors: the published model is of "));
    const Execution unwritable = run(folder, "hdp_train " + dataset + " --picture=/no/such/x.png -o " + model);
    EXPECT_EQ("error: cannot write '/no/such/x.png'\n", unwritable.errors);
#ifdef __linux__
    ASSERT_EQ(0, symlink("/dev/full", folder.path("full.yml").c_str()));
    const Execution full =
        run(folder, "hdp_train " + dataset + " --layers=2 --max-components=1 -o " + folder.path("full.yml"));
    EXPECT_EQ(1, full.status);
    EXPECT_NE(String::npos, full.errors.find("error: cannot write '" + folder.path("full.yml") + "'\n")) << full.errors;
#endif
}

TEST(HDPStereo_EvaluationPrograms, read_16_bit)
{
    const FaintPair faint;
    const DatasetFolder& folder = faint.folder;
    const Execution evaluated =
        run(folder, "hdp_evaluate " + folder.path("scenes") + " --num-disparities=32 --methods=fast,opencv --maps=" +
                        folder.path("maps") + " --report=" + folder.path("report"));
    EXPECT_EQ(0, evaluated.status) << evaluated.errors;
    EXPECT_LT(faint.countErrors("maps/fast/scenes/faint.png", 1. / 256),
              0.75 * faint.countErrors("maps/fast/scenes/rounded.png", 1. / 256));
    const Execution result = run(folder, "hdp_benchmark --runs=1 --methods=fast,opencv" + faint.images("faint"));
    EXPECT_EQ(0, result.status) << result.errors;
    const String option = " --truth=" + folder.path("scenes/faint/disp_left.png") + " --output=" + folder.root;
    EXPECT_EQ(0, run(folder, "hdp_pictures" + faint.images("faint") + option).status);
}

}} // namespace opencv_test

#endif
