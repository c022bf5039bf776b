#include "rewriter/shared_declaration.h"

#include "rewriter/lexer.h"

namespace cudasim {
namespace {

constexpr std::size_t kNone = std::string::npos;

std::string trimmed(const std::string& text) {
    const char* blanks = " \t\r\n";
    const std::size_t begin = text.find_first_not_of(blanks);
    return begin == kNone ? "" : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// Blanks out alignas(...), __align__(...) and __attribute__((...)): they may stand nearly anywhere.
std::string without_attributes(std::string text) {
    for (const char* attribute : {"alignas", "__align__", "__attribute__"}) {
        for (std::size_t at = text.find(attribute); at != kNone; at = text.find(attribute)) {
            const std::size_t open = text.find('(', at);
            const std::size_t close = open == kNone ? kNone : find_outside_brackets(text, open + 1, ")");
            // find_outside_brackets stops at the bracket that closes ours.
            if (close == kNone) return text;
            text.replace(at, close + 1 - at, " ");
        }
    }
    return text;
}

/// Parts between commas that are in no bracket and no template argument list.
std::vector<std::string> split_at_commas(const std::string& text) {
    std::vector<std::string> parts(1);
    int brackets = 0, angles = 0;
    for (const char c : text) {
        if (c == '(' || c == '[' || c == '{') ++brackets;
        if (c == ')' || c == ']' || c == '}') --brackets;
        if (brackets == 0 && c == '<') ++angles;
        if (brackets == 0 && c == '>') --angles;
        if (c == ',' && brackets == 0 && angles == 0)
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

/// The last word of "float tile" before the sizes; empty if there is none.
std::string last_word(const std::string& text) {
    const std::string head = trimmed(text);
    std::size_t begin = head.size();
    while (begin > 0 && is_word(head[begin - 1])) --begin;
    return head.substr(begin);
}

}  // namespace

std::optional<std::vector<std::string>> declared_names(const std::string& declaration) {
    const std::string plain = without_attributes(without_literals(declaration));
    std::vector<std::string> names;
    for (const std::string& part : split_at_commas(plain)) {
        const std::string head = part.substr(0, part.find('['));
        if (head.find_first_of("(){}=") != kNone) return std::nullopt;
        const std::string name = last_word(head);
        const bool has_type = trimmed(head) != name;
        if (name.empty() || (names.empty() && !has_type)) return std::nullopt;
        names.push_back(name);
    }
    return names;
}

std::optional<DynamicArray> dynamic_array(const std::string& declaration) {
    const std::string plain = trimmed(without_attributes(without_literals(declaration)));
    const std::size_t bracket = plain.find('[');
    if (bracket == kNone || trimmed(plain.substr(bracket + 1)) != "]") return std::nullopt;
    const std::string head = trimmed(plain.substr(0, bracket));
    const std::string name = last_word(head);
    const std::string type = trimmed(head.substr(0, head.size() - name.size()));
    if (name.empty() || type.empty() || type.find_first_of("(),") != kNone) return std::nullopt;
    return DynamicArray{type, name};
}

}  // namespace cudasim
