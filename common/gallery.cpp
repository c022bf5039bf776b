/// @file
/// course_gallery OUT: reads the result.json of every chapter folder in OUT and writes OUT/index.html.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/errors.h"
#include "common/files.h"

namespace {

std::string escape(const std::string& text) {
    std::string out;
    for (char c : text)
        out += c == '<'   ? "&lt;"
               : c == '>' ? "&gt;"
               : c == '&' ? "&amp;"
               : c == '"' ? "&quot;"
                          : std::string(1, c);
    return out;
}

const char* const kHead = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Fire &amp; Water on the GPU: the tour</title><style>
body{font:16px/1.5 system-ui,sans-serif;max-width:72rem;margin:2rem auto;padding:0 1rem;color:#1d2733;background:#fbfcfd}
h1{margin-bottom:0}h2{margin-top:3rem;border-top:1px solid #d5dce4;padding-top:1.5rem}
figure{display:inline-block;margin:.5rem 1rem .5rem 0;max-width:100%;vertical-align:top}
figure img{max-width:100%;width:34rem;border-radius:6px;display:block}figure.wide img{width:70rem}
figcaption{color:#52616f;font-size:.9rem}table{border-collapse:collapse;margin:1rem 0}
caption{text-align:left;color:#52616f}th,td{padding:.2rem .8rem;border-bottom:1px solid #e1e7ed;text-align:right}
th:first-child,td:first-child{text-align:left}code{background:#eef2f6;padding:.1rem .3rem;border-radius:3px}
</style></head><body><h1>Fire &amp; Water on the GPU</h1><p>The tour of all chapters on this machine.</p>
)";

void add_chapter(std::string& html, const std::string& folder, const nlohmann::json& result) {
    const auto text = [&](const char* key) { return escape(result.at(key).get<std::string>()); };
    html += "<section id=\"" + escape(folder) + "\"><h2>" + text("title") + "</h2>\n<p>" + text("sentence") +
            "</p>\n<p><code>" + text("command") + "</code> &middot; computed on: " + text("device") +
            "</p>\n";
    for (const auto& picture : result.at("pictures")) {
        const std::string source = escape(folder + "/" + picture.at("file").get<std::string>());
        const std::string caption = escape(picture.at("caption").get<std::string>());
        html += "<figure><a href=\"" + source + "\"><img src=\"" + source + "\" alt=\"" + caption +
                "\"></a><figcaption>" + caption + "</figcaption></figure>\n";
    }
    for (const auto& table : result.at("tables")) {
        html += "<table><caption>" + escape(table.at("caption").get<std::string>()) + "</caption><tr>";
        for (const auto& name : table.at("columns"))
            html += "<th>" + escape(name.get<std::string>()) + "</th>";
        html += "</tr>\n";
        for (const auto& row : table.at("rows")) {
            html += "<tr>";
            for (const auto& cell : row) html += "<td>" + escape(cell.get<std::string>()) + "</td>";
            html += "</tr>\n";
        }
        html += "</table>\n";
    }
    for (const auto& note : result.at("notes")) html += "<p>" + escape(note.get<std::string>()) + "</p>\n";
    html += "</section>\n";
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: course_gallery FOLDER\n");
        return 2;
    }
    const std::filesystem::path out = argv[1];
    int status = 0;
    try {
        std::vector<std::string> folders;
        for (const auto& entry : std::filesystem::directory_iterator(out))
            if (std::filesystem::exists(entry.path() / "result.json"))
                folders.push_back(entry.path().filename().string());
        if (folders.empty()) throw course::BadInput("no chapter result in " + out.string());
        std::sort(folders.begin(), folders.end());  // folder names begin with the chapter's number
        std::string html = kHead;
        for (const std::string& folder : folders) {
            std::ifstream file(out / folder / "result.json");
            std::string section;
            try {
                add_chapter(section, folder, nlohmann::json::parse(file));
                html += section;
            } catch (
                const nlohmann::json::exception& error) {  // one bad file must not hide the other chapters
                std::fprintf(stderr, "course_gallery: left out %s/result.json: %s\n", folder.c_str(),
                             error.what());
                status = 2;
            }
        }
        course::write_file(out / "index.html", html + "</body></html>\n");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "course_gallery: %s\n", error.what());
        return 2;
    }
    return status;
}
