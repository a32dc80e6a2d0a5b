// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// --set and --list-tunables: of a build with HDPSTEREO_TUNABLE, and of one without.

#include "test_precomp.hpp"
#include "programs.hpp"

#ifdef __unix__

namespace opencv_test { namespace {

const char* const programs[] = { "hdp_evaluate", "hdp_parameters", "hdp_robustness", "hdp_stability", "hdp_video" };

#ifdef HDPSTEREO_TUNABLE

String mapWith(const DatasetFolder& folder, const String& settings)
{
    const Execution result = run(folder, "hdp_evaluate --methods=fast --num-disparities=32 " + folder.path("dataset") +
                                             " --maps=" + folder.path("maps") + " " + settings);
    EXPECT_EQ(0, result.status) << result.errors;
    return readText(folder.path("maps/fast/dataset/a.png"));
}

TEST(HDPStereo_Tunables, set_changes_maps)
{
    const DatasetFolder folder;
    writePair(folder);
    for (const char* scene : { "a", "b", "c" }) // their rows are moved, which the alignment finds
    {
        const String file = folder.path("dataset/") + scene + "/right.png";
        const Mat right = cv::imread(file);
        Mat moved;
        cv::copyMakeBorder(right.rowRange(0, right.rows - 2), moved, 2, 0, 0, 0, BORDER_REPLICATE);
        cv::imwrite(file, moved);
    }
    const String map = mapWith(folder, "");
    EXPECT_TRUE(map == mapWith(folder, "--set row_alignment.trackedArea=600000 --set=row_alignment.minMove=.12"));
    EXPECT_FALSE(map == mapWith(folder, "--set tree_planes.triples=60,row_alignment.minMove=100"));
}

TEST(HDPStereo_Tunables, list)
{
    const DatasetFolder folder;
    for (const String program : programs)
    {
        const Execution result = run(folder, program + " --list-tunables --set tree_planes.minShare=0.25");
        EXPECT_EQ(0, result.status) << result.errors;
        EXPECT_NE(String::npos,
                  result.output.find("\ntree_planes.minShare = 0.25 (built with 0.5) [share of the samples] "));
        EXPECT_NE(String::npos, result.output.find("\nrow_alignment.trackedArea = 600000 [pixels] "));
    }
}

TEST(HDPStereo_Tunables, wrong_settings)
{
    const DatasetFolder folder;
    writePair(folder);
    for (const String program : programs)
        for (const char* wrong : { "minShare=1", "tree_planes.minShare", "tree_planes.minShare=", "=1",
                                   "tree_planes.minShare=half", "tree_planes.minShare=1x", "tree_planes.minShare=inf",
                                   "tree_planes.minShare=nan", "tree_planes.triples=1.5", "tree_planes.triples=1e10" })
        {
            const Execution result = run(folder, program + " " + folder.path("dataset") + " --set " + wrong);
            EXPECT_EQ(1, result.status) << wrong;
            EXPECT_EQ(0u, result.errors.find("error: ")) << result.errors;
            EXPECT_EQ(firstLine(result.errors) + "\n", result.errors);
        }
    const Execution unknown = run(folder, "hdp_evaluate --set a.b=1 " + folder.path("dataset"));
    EXPECT_NE(String::npos, unknown.errors.find("'a.b', there are: blank_borders.maxBlack, ")) << unknown.errors;
    EXPECT_NE(String::npos, unknown.errors.find(", tree_planes.triples")) << unknown.errors;
}

TEST(HDPStereo_Tunables, sweep)
{
    const DatasetFolder folder;
    writePair(folder);
    const String command = "hdp_parameters --runs=1 --presets=quality " + folder.path("dataset") + " --sweep=";
    const Execution good = run(folder, command + "tree_planes.triples,tree_planes.minShare=.2:.6 --changes=flip,top1");
    EXPECT_EQ(0, good.status) << good.errors;
    for (const char* row : { "| dataset: quality with | average error, pixels | D1 % | time |", "\n| quality | ",
                             "\n| tree_planes.triples = 30 | ", "\n| tree_planes.triples = 120 | ",
                             "\n| tree_planes.minShare = .2 | ", "\n| tree_planes.minShare = .6 | " })
        EXPECT_NE(String::npos, good.output.find(row)) << row << good.output;
    for (const char* wrong : { "triples", "tree_planes.triples=", "tree_planes.triples=1:x" })
        EXPECT_EQ(1, run(folder, command + wrong).status) << wrong;
}

#else

TEST(HDPStereo_Tunables, not_of_this_build)
{
    const DatasetFolder folder;
    writePair(folder);
    for (const String program : programs)
        for (const char* option : { " --set tree_planes.triples=4", " --list-tunables" })
        {
            const Execution result = run(folder, program + " " + folder.path("dataset") + option);
            EXPECT_EQ(1, result.status);
            EXPECT_NE(String::npos, result.errors.find(" needs a library that was built with HDPSTEREO_TUNABLE"));
            EXPECT_EQ(firstLine(result.errors) + "\n", result.errors);
        }
    EXPECT_EQ(1, run(folder, "hdp_parameters --sweep=tree_planes.triples " + folder.path("dataset")).status);
}

#endif

}} // namespace opencv_test

#endif // __unix__
