#include "rewriter/lexer.h"

#include <algorithm>
#include <cctype>

namespace cudasim {
namespace {

constexpr std::size_t kEnd = std::string::npos;

bool starts_with(const std::string& source, std::size_t at, const std::string& text) {
    return source.compare(at, text.size(), text) == 0;
}

std::size_t length_until(const std::string& source, std::size_t at, std::size_t end) {
    return std::min(end, source.size()) - at;
}

/// R"x( ... )x"; `quote` is the position of its first quotation mark.
std::size_t raw_string_length(const std::string& source, std::size_t at, std::size_t quote) {
    const std::size_t open = source.find('(', quote);
    if (open == kEnd) return source.size() - at;
    const std::string close = ")" + source.substr(quote + 1, open - quote - 1) + "\"";
    const std::size_t end = source.find(close, open);
    return end == kEnd ? source.size() - at : end + close.size() - at;
}

std::size_t line_comment_length(const std::string& source, std::size_t at) {
    std::size_t end = source.find('\n', at);
    while (end != kEnd && source[end - 1] == '\\')
        end = source.find('\n', end + 1);  // it goes on in the next line
    return length_until(source, at, end);
}

}  // namespace

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

std::size_t word_length(const std::string& source, std::size_t at) {
    std::size_t end = at;
    while (end < source.size() && is_word(source[end])) ++end;
    return end - at;
}

std::size_t literal_length(const std::string& source, std::size_t at) {
    if (starts_with(source, at, "//")) return line_comment_length(source, at);
    if (starts_with(source, at, "/*")) {
        const std::size_t end = source.find("*/", at + 2);
        return length_until(source, at, end == kEnd ? kEnd : end + 2);
    }
    const bool inside_word = at > 0 && is_word(source[at - 1]);
    if (!inside_word)
        for (const char* prefix : {"R\"", "LR\"", "uR\"", "UR\"", "u8R\""})
            if (starts_with(source, at, prefix)) return raw_string_length(source, at, source.find('"', at));
    const char quote = source[at];
    if (quote != '"' && quote != '\'') return 0;
    if (quote == '\'' && inside_word) return 0;  // 1'000'000
    std::size_t end = at + 1;
    while (end < source.size() && source[end] != quote && source[end] != '\n')
        end += source[end] == '\\' ? 2 : 1;
    return length_until(source, at, end + 1);
}

std::size_t find_outside_brackets(const std::string& source, std::size_t at, const std::string& wanted) {
    int depth = 0;
    while (at < source.size()) {
        if (const std::size_t length = literal_length(source, at)) {
            at += length;
            continue;
        }
        if (depth == 0 && starts_with(source, at, wanted)) return at;
        if (std::string("([{").find(source[at]) != kEnd) ++depth;
        if (std::string(")]}").find(source[at]) != kEnd && --depth < 0) return kEnd;
        ++at;
    }
    return kEnd;
}

std::string without_literals(const std::string& source) {
    std::string text = source;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t length = literal_length(source, at);
        for (std::size_t k = at; k < at + length; ++k)
            if (text[k] != '\n') text[k] = ' ';
        at += std::max<std::size_t>(length, 1);
    }
    return text;
}

}  // namespace cudasim
