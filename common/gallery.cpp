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
#include "common/html.h"

namespace {

using course::escape_html;

void add_chapter(std::string& html, const std::string& folder, const nlohmann::json& result) {
    const auto text = [&](const char* key) { return escape_html(result.at(key).get<std::string>()); };
    html += "<section id=\"" + escape_html(folder) + "\"><h2>" + text("title") + "</h2>\n<p>" +
            text("sentence") + "</p>\n<p><code>" + text("command") +
            "</code> &middot; computed on: " + text("device") + "</p>\n";
    for (const auto& picture : result.at("pictures")) {
        const std::string source = escape_html(folder + "/" + picture.at("file").get<std::string>());
        const std::string caption = escape_html(picture.at("caption").get<std::string>());
        html += "<figure><a href=\"" + source + "\"><img src=\"" + source + "\" alt=\"" + caption +
                "\"></a><figcaption>" + caption + "</figcaption></figure>\n";
    }
    for (const auto& table : result.at("tables")) {
        html += "<table><caption>" + escape_html(table.at("caption").get<std::string>()) + "</caption><tr>";
        for (const auto& name : table.at("columns"))
            html += "<th>" + escape_html(name.get<std::string>()) + "</th>";
        html += "</tr>\n";
        for (const auto& row : table.at("rows")) {
            html += "<tr>";
            for (const auto& cell : row) html += "<td>" + escape_html(cell.get<std::string>()) + "</td>";
            html += "</tr>\n";
        }
        html += "</table>\n";
    }
    for (const auto& note : result.at("notes"))
        html += "<p>" + escape_html(note.get<std::string>()) + "</p>\n";
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
        std::string html =
            course::html_head("Fire & Water on the GPU", "The tour of all chapters on this machine.");
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
