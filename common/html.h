/// @file
/// What the pages that programs make have in common: the gallery and the report.
#pragma once
#include <string>

namespace course {

/// Text as HTML shows it.
inline std::string escape_html(const std::string& text) {
    std::string out;
    for (char c : text)
        out += c == '<'   ? "&lt;"
               : c == '>' ? "&gt;"
               : c == '&' ? "&amp;"
               : c == '"' ? "&quot;"
                          : std::string(1, c);
    return out;
}

/// Everything up to the page's first paragraph. One look for all pages, readable on paper as well.
inline std::string html_head(const std::string& title, const std::string& first_sentence) {
    return R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>)" + escape_html(title) +
           R"(</title><style>
body{font:16px/1.5 system-ui,sans-serif;max-width:72rem;margin:2rem auto;padding:0 1rem;color:#1d2733;background:#fbfcfd}
h1{margin-bottom:0}h2{margin-top:3rem;border-top:1px solid #d5dce4;padding-top:1.5rem}h3{margin-top:2.5rem}
figure{display:inline-block;margin:.5rem 1rem .5rem 0;max-width:100%;vertical-align:top}
figure img{max-width:100%;width:34rem;border-radius:6px;display:block}figure.wide img{width:70rem}
figcaption{color:#52616f;font-size:.9rem}table{border-collapse:collapse;margin:1rem 0}
caption{text-align:left;color:#52616f}th,td{padding:.2rem .8rem;border-bottom:1px solid #e1e7ed;text-align:right}
th:first-child,td:first-child{text-align:left}code{background:#eef2f6;padding:.1rem .3rem;border-radius:3px}
.conclusion{border-left:4px solid #0072b2;padding-left:.8rem;max-width:60rem}.failed{color:#a33a00}
@media print{body{background:#fff}h3{break-before:auto;break-after:avoid}figure{break-inside:avoid}}
</style></head><body><h1>)" +
           escape_html(title) + "</h1><p>" + escape_html(first_sentence) + "</p>\n";
}

}  // namespace course
