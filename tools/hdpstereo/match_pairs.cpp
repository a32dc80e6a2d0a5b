// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../paths.hpp"
#include "files.hpp"
#include "rectifier.hpp"
#include "windows.hpp"

#include <fstream>
#include <iostream>
#include <set>
#include <sstream>
#ifdef __unix__
#include <unistd.h>
#endif

#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"

using namespace cv;
using cv::stereo::HDPTreeMatcher;
using hdp_tools::fileName;

struct NamedPair
{
    String left, right, name;
};

static String withoutExtension(const String& name) { return name.substr(0, name.rfind('.')); }

static std::vector<NamedPair> pairsOfFolders(const String& lefts, const String& rights)
{
    for (const String& folder : { lefts, rights })
        if (!utils::fs::isDirectory(folder))
            CV_Error(Error::StsObjectNotFound, "there is no folder '" + folder + "'");
    std::vector<String> paths;
    glob(utils::fs::join(lefts, "*"), paths);
    std::vector<NamedPair> pairs;
    for (const String& path : paths)
        if (haveImageWriter(path)) // by its extension
            pairs.push_back({ path, utils::fs::join(rights, fileName(path)), withoutExtension(fileName(path)) });
    return pairs;
}

//! A name without parts that say nothing, as a/./b; empty if it is not that of a file below a folder
static String nameBelow(const String& name)
{
    std::istringstream parts(name);
    String below;
    for (std::string part; std::getline(parts, part, '/');)
    {
        if (part == ".." || name[0] == '/')
            return String();
        if (!part.empty() && part != ".")
            below = below.empty() ? part : below + "/" + part;
    }
    return below;
}

static std::vector<NamedPair> pairsOfList(const String& list)
{
    std::ifstream file(list.c_str());
    if (!file)
        CV_Error(Error::StsObjectNotFound, "there is no file or folder '" + list + "'");
    std::vector<NamedPair> pairs;
    std::string line;
    for (int number = 1; std::getline(file, line); number++)
    {
        if (number == 1 && line.compare(0, 3, "\xEF\xBB\xBF") == 0) // the mark of UTF-8
            line.erase(0, 3);
        std::istringstream words(line);
        std::vector<String> parts;
        const char delimiter = line.find('\t') != std::string::npos ? '\t' : ' ';
        for (std::string word; std::getline(words, word, delimiter);)
            if (word.find_first_not_of(" \r") != std::string::npos)
                parts.push_back(word.substr(0, word.find('\r')));
        if (parts.empty())
            continue;
        if (parts.size() != 3)
            CV_Error(Error::StsBadArg,
                     format("'%s': line %d is not a left image, a right one and a name", list.c_str(), number));
        const String name = nameBelow(parts[2]);
        if (name.empty())
            CV_Error(Error::StsBadArg,
                     format("'%s': line %d: the name '%s' is not in OUT", list.c_str(), number, parts[2].c_str()));
        pairs.push_back({ parts[0], parts[1], name });
    }
    return pairs;
}

//! One line on a terminal, which the next one replaces
static void printProgress(size_t done, size_t total, const String& name)
{
#ifdef __unix__
    static const bool isTerminal = isatty(STDERR_FILENO) != 0;
#else
    static const bool isTerminal = false;
#endif
    std::cerr << (isTerminal ? "\r\x1b[K" : "") << done << "/" << total << " " << name;
    if (isTerminal && done < total)
        std::cerr << std::flush;
    else
        std::cerr << std::endl;
}

//! Of what a file has, by FNV-1a: names do not tell whether it has changed.
static String fingerprintOf(const String& path)
{
    std::ifstream file(path.c_str(), std::ios::binary);
    uint64 hash = 14695981039346656037ull;
    for (std::istreambuf_iterator<char> byte(file), end; byte != end; ++byte)
        hash = (hash ^ (uchar)*byte) * 1099511628211ull;
    return format("%016llx", (unsigned long long)hash);
}

//! What the maps in a folder were made with, so that those of other options are not taken for these
static String optionsFile(const String& out) { return utils::fs::join(out, "hdpstereo.yml"); }

//! The text that this file is to get; empty if it has it. Throws if it has another one.
static String newOptions(const CommandLineParser& parser, const HDPTreeMatcher& matcher, const Rectifier& rectifier,
                         const String& out)
{
    FileStorage options(".yml", FileStorage::WRITE | FileStorage::MEMORY);
    options << "version" << HDPSTEREO_VERSION;
    const String lefts = parser.get<String>("@left"), rights = parser.get<String>("@right");
    if (utils::fs::isDirectory(lefts)) // else it is a list, of which the pairs may become more
        options << "lefts" << hdp_tools::placeOf(lefts) << "rights" << hdp_tools::placeOf(rights);
    options << "numDisparities"
            << (parser.has("num-disparities") ? parser.get<String>("num-disparities") : "width / 5");
    if (parser.has("findings"))
    {
        options << "findings"
                << "{";
        findingsOf(parser).write(options);
        options << "}";
    }
    const std::pair<const char*, const char*> inputs[] = { { "left-mask", "leftMask" },
                                                           { "right-mask", "rightMask" },
                                                           { "smallest", "smallest" },
                                                           { "largest", "largest" },
                                                           { "prior", "prior" } };
    for (const auto& input : inputs)
        if (parser.has(input.first))
            options << input.second << fingerprintOf(parser.get<String>(input.first));
    if (parser.has("prior"))
        options << "priorSigma" << parser.get<String>("prior-sigma");
    rectifier.write(options);
    options << "matcher"
            << "{";
    matcher.write(options);
    options << "}";
    const String text = options.releaseAndGetString(), path = optionsFile(out);
    std::ifstream file(path.c_str());
    const String before((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    if (!before.empty() && before != text)
        CV_Error(Error::StsBadArg, "the maps in '" + out + "' were made with other options, see '" + path +
                                       "': take another folder, or remove it");
    return before.empty() ? text : String();
}

static void makeFolder(const String& out)
{
    if (!utils::fs::createDirectories(out))
        CV_Error(Error::StsError, "cannot make the folder '" + out + "'");
    requireFolderOf(optionsFile(out)); // so that it can be written to
}

static void checkBatchOptions(const CommandLineParser& parser)
{
    for (const char* option : { "output", "picture", "truth", "point-cloud", "depth", "compare", "save-findings",
                                "sigma", "confidence", "reasons" })
        if (parser.has(option))
            CV_Error(Error::StsBadArg, format("--%s is for one pair, and not for --batch", option));
    const String format = parser.get<String>("format");
    if (format != "png" && format != "pfm" && format != "tif")
        CV_Error(Error::StsBadArg, "--format=" + format + " is unknown, see --help");
    if (format == "png")
        requireDisparitiesOfPng(parser);
}

size_t matchPairs(const CommandLineParser& parser)
{
    checkBatchOptions(parser);
    const String format = parser.get<String>("format"), lefts = parser.get<String>("@left");
    const bool areFolders = utils::fs::isDirectory(lefts) || parser.has("@out"); // or are meant to be
    const String out = parser.get<String>(areFolders ? "@out" : "@right");
    if (out.empty())
        CV_Error(Error::StsBadArg, "--batch needs LEFTS RIGHTS OUT, three folders, or LIST OUT, a file and a folder");
    for (const String& folder : { lefts, parser.get<String>("@right") })
        if (areFolders && isSameFile(out, folder))
            CV_Error(Error::StsBadArg, "OUT must be another folder than that of the images, '" + folder + "'");
    const std::vector<NamedPair> pairs =
        areFolders ? pairsOfFolders(lefts, parser.get<String>("@right")) : pairsOfList(lefts);
    if (pairs.empty())
        CV_Error(Error::StsBadArg, "there is no pair in '" + lefts + "'");
    const auto mapOf = [&](const NamedPair& pair) { return utils::fs::join(out, pair.name + "." + format); };
    std::set<String> names, images;
    for (const NamedPair& pair : pairs)
    {
        if (!names.insert(pair.name).second)
            CV_Error(Error::StsBadArg, "two pairs have the name '" + pair.name + "'");
        for (const String& image : { pair.left, pair.right })
            if (utils::fs::exists(image))
                images.insert(hdp_tools::placeOf(image));
    }
    for (const NamedPair& pair : pairs)
        if (utils::fs::exists(mapOf(pair)) && images.count(hdp_tools::placeOf(mapOf(pair))) > 0)
            CV_Error(Error::StsBadArg, "the map '" + mapOf(pair) + "' must not be one of the images");

    // One for all pairs: it keeps its memory.
    const Ptr<HDPTreeMatcher> matcher = createMatcher(parser, 0);
    const MaskFiles masks(parser);
    Rectifier rectifier(parser);
    String options = newOptions(parser, *matcher, rectifier, out);
    if (!options.empty())
        makeFolder(out);
    size_t done = 0, old = 0, bad = 0;
    for (const NamedPair& pair : pairs)
    {
        const String path = mapOf(pair);
        done++;
        const bool isFolder = utils::fs::isDirectory(path);
        if (utils::fs::exists(path) && !isFolder)
        {
            old++;
            continue;
        }
        std::vector<uchar> bytes;
        try
        {
            if (isFolder)
                CV_Error(Error::StsError, "'" + path + "' is a folder");
            Mat leftMask, rightMask, left = readPicture(pair.left, leftMask),
                                     right = readPicture(pair.right, rightMask);
            makeAlike(left, right);
            if (!rectifier.apply(left, right, leftMask, rightMask, *matcher))
                masks.apply(leftMask, rightMask, *matcher);
            matcher->setNumDisparities(numDisparitiesOf(parser, left.cols));
            bytes = encodeDisparity("." + format, computeDisparity(*matcher, left, right));
        }
        catch (const cv::Exception& e)
        {
            bad++;
            printProgress(done, pairs.size(), pair.name + " left out: " + e.err + "\n");
            continue;
        }
        if (!options.empty()) // with the first map
            writeWholeFile(optionsFile(out), std::vector<uchar>(options.begin(), options.end()));
        options.clear();
        utils::fs::createDirectories(utils::fs::getParent(path));
        writeWholeFile(path, bytes);
        printProgress(done, pairs.size(), pair.name);
    }
    std::cout << pairs.size() - old - bad << " pairs matched, " << old << " were there, " << bad << " left out"
              << std::endl;
    return bad;
}
