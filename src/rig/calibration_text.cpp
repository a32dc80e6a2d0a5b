// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.
#include "../precomp.hpp"
#include "calibration_text.hpp"

#include <cctype>
#include <cmath>
#include <cstring>
#include <locale>
#include <sstream>

namespace cv { namespace stereo { namespace hdp {

namespace {

std::string trimmed(const std::string& text)
{
    const char* const blanks = " \t\r";
    const size_t first = text.find_first_not_of(blanks);
    return first == std::string::npos ? std::string() : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string withoutQuotes(const std::string& word)
{
    const bool isQuoted = word.size() >= 2 && (word[0] == '"' || word[0] == '\'') && word.back() == word[0];
    return isQuoted ? word.substr(1, word.size() - 2) : word;
}

//! Up to a mark of comments that follows a blank and is in no quotes
std::string withoutComment(const std::string& line, const char* marks)
{
    char quote = 0;
    for (size_t i = 0; i < line.size(); ++i)
    {
        const bool isAfterBlank = i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t';
        if (quote)
            quote = line[i] == quote ? 0 : quote;
        else if (isAfterBlank && std::strchr(marks, line[i]))
            return line.substr(0, i);
        else if (isAfterBlank && (line[i] == '"' || line[i] == '\''))
            quote = line[i];
    }
    return line;
}

std::string inUpperCase(std::string text)
{
    for (char& c : text)
        c = (char)std::toupper((uchar)c);
    return text;
}

class FieldReader
{
public:
    FieldReader(const std::string& file, CalibrationText::Fields& fields) : file_(file), fields_(fields) {}

    void readIni(std::istream& lines)
    {
        std::string line, section;
        while (nextLine(lines, line))
        {
            line = trimmed(withoutComment(line, "#;"));
            const size_t equals = line.find('=');
            if (line.empty())
                continue;
            if (line[0] == '[' && line.back() == ']')
                section = inUpperCase(trimmed(line.substr(1, line.size() - 2)));
            else if (equals == std::string::npos || equals == 0)
                fail("is neither [SECTION] nor KEY=VALUE");
            else
                addField(section + "/" + inUpperCase(trimmed(line.substr(0, equals))),
                         { withoutQuotes(trimmed(line.substr(equals + 1))) });
        }
    }

    //! A list in brackets may go over several lines.
    void readYaml(std::istream& lines)
    {
        std::string line;
        while (nextLine(lines, line))
            readLine(line);
        if (depth_ > 0)
            fail("is the last one, and a list has no closing bracket");
    }

private:
    //! What following lines that are indented by more belong to
    struct Parent
    {
        size_t indentation;
        std::string path;
    };

    [[noreturn]] void fail(const std::string& what) const
    {
        CV_Error(Error::StsParseError, format("'%s': line %d %s", file_.c_str(), line_, what.c_str()));
    }

    void addField(const std::string& path, const std::vector<std::string>& words)
    {
        if (!fields_.insert(std::make_pair(path, words)).second)
            fail("has '" + path + "' for the second time");
    }

    bool nextLine(std::istream& lines, std::string& line)
    {
        if (!std::getline(lines, line))
            return false;
        ++line_;
        if (line.find('\0') != std::string::npos)
            fail("has a byte 0: this is no text");
        return true;
    }

    void readLine(const std::string& line)
    {
        std::string content = trimmed(withoutComment(line, "#"));
        if (content.empty() || content == "---" || content == "..." || line[0] == '%')
            return;
        if (depth_ > 0)
            return readList(content);
        const size_t indentation = line.find_first_not_of(' ');
        if (line[indentation] == '\t')
            fail("is indented by a tab: YAML wants blanks");
        // An item may be indented as its key is.
        const size_t outside = indentation + (isItem(content) ? 1 : 0);
        while (!parents_.empty() && parents_.back().indentation >= outside)
            parents_.pop_back();
        if (isItem(content))
        {
            if (parents_.empty())
                fail("is an item of a list without a name");
            path_ = parents_.back().path;
            while (isItem(content))
                content = trimmed(content.substr(1));
            return readValue(content);
        }
        const size_t colon = std::min((content + " ").find(": "), content.find(":\t"));
        if (colon == std::string::npos || colon == 0)
            fail("is neither 'key: value' nor an item of a list");
        path_ = (parents_.empty() ? "" : parents_.back().path + "/") + withoutQuotes(trimmed(content.substr(0, colon)));
        addField(path_, {});
        parents_.push_back({ indentation, path_ });
        readValue(trimmed(content.substr(colon + 1)));
    }

    static bool isItem(const std::string& content) { return content == "-" || content.compare(0, 2, "- ") == 0; }

    //! Adds a value to the field of path_.
    void readValue(std::string value)
    {
        if (value.compare(0, 1, "!") == 0) // a tag, such as OpenCV's !!opencv-matrix
            value = trimmed(value.substr(std::min(value.find(' '), value.size())));
        if (value.empty())
            return;
        if (value[0] == '|' || value[0] == '>')
            fail("begins a text of several lines, which is not read");
        if (value[0] == '[' || value[0] == '{')
            return readList(value);
        fields_[path_].push_back(withoutQuotes(value));
    }

    //! What is between brackets and commas
    void readList(const std::string& content)
    {
        std::string word;
        for (const char c : content + ",")
        {
            const bool opens = c == '[' || c == '{', closes = c == ']' || c == '}';
            if (!opens && !closes && c != ',')
            {
                word += c;
                continue;
            }
            word = trimmed(word);
            if (!word.empty() && depth_ == 0)
                fail("goes on after the closing bracket");
            if (!word.empty())
                fields_[path_].push_back(withoutQuotes(word));
            word.clear();
            depth_ += opens ? 1 : closes ? -1 : 0;
            if (depth_ < 0)
                fail("closes a bracket that was not opened");
        }
    }

    const std::string& file_;
    CalibrationText::Fields& fields_;
    int line_ = 0;
    int depth_ = 0;    // brackets that are open
    std::string path_; // of the value that is being read
    std::vector<Parent> parents_;
};

} // namespace

CalibrationText::CalibrationText(const std::string& file, const std::string& text) : file_(file)
{
    const bool hasMark = text.compare(0, 3, "\xEF\xBB\xBF") == 0; // of UTF-8
    std::istringstream lines(hasMark ? text.substr(3) : text);
    std::string line;
    while (line.empty() && std::getline(lines, line))
        line = trimmed(withoutComment(line, "#;"));
    lines.clear();
    lines.seekg(0);
    FieldReader reader(file, fields_);
    if (line.compare(0, 1, "[") == 0)
        reader.readIni(lines);
    else
        reader.readYaml(lines);
}

bool CalibrationText::hasBelow(const std::string& prefix) const
{
    const auto next = fields_.lower_bound(prefix);
    return next != fields_.end() && next->first.compare(0, prefix.size(), prefix) == 0;
}

void CalibrationText::fail(const std::string& path, const std::string& expected) const
{
    CV_Error(Error::StsParseError,
             "'" + file_ + "': " + path + (has(path) ? " must be " : " is missing, which must be ") + expected);
}

std::string CalibrationText::word(const std::string& path) const
{
    if (!has(path) || fields_.at(path).size() != 1)
        fail(path, "one word");
    return fields_.at(path)[0];
}

std::vector<double> CalibrationText::numbers(const std::string& path, size_t count) const
{
    const std::string expected = count == 0   ? "finite numbers"
                                 : count == 1 ? "a finite number"
                                              : format("%d finite numbers", (int)count);
    if (!has(path) || (count > 0 && fields_.at(path).size() != count))
        fail(path, expected);
    std::vector<double> values;
    for (const std::string& word : fields_.at(path))
    {
        std::istringstream stream(word);
        stream.imbue(std::locale::classic());
        double value;
        if (!(stream >> value) || stream.peek() != EOF || !std::isfinite(value))
            fail(path, expected + ", not '" + word + "'");
        values.push_back(value);
    }
    return values;
}

}}} // namespace cv::stereo::hdp
