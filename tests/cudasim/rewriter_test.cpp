// The tool that turns CUDA C++ into C++: what it must rewrite, and what it must leave alone.
#include "rewriter/rewriter.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

/// What the rewriter makes of the source, without its own first line.
std::string rewritten(const std::string& source) {
    const std::string text = cudasim::rewrite(source, "dir/file.cu");
    const std::string first = "#line 1 \"dir/file.cu\"\n";
    REQUIRE(text.substr(0, first.size()) == first);
    return text.substr(first.size());
}

void check_unchanged(const std::string& source) {
    CHECK(rewritten(source) == source);
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

auto newlines(const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
}

}  // namespace

TEST_CASE("rewriter: launches") {
    CHECK(rewritten("k<<<1, 2>>>(a);") == "CUDASIM_LAUNCH(k)(1, 2)(a);");
    CHECK(rewritten("  k <<< g, b, 4, s >>> (a);") == "  CUDASIM_LAUNCH(k) ( g, b, 4, s ) (a);");
    CHECK(rewritten("ns::k<<<1, 2>>>(a);") == "CUDASIM_LAUNCH(ns::k)(1, 2)(a);");
    CHECK(rewritten("::k<int, 3><<<1, 2>>>(a);") == "CUDASIM_LAUNCH(::k<int, 3>)(1, 2)(a);");
    CHECK(rewritten("k<a<b<c>>><<<1, 2>>>(a);") == "CUDASIM_LAUNCH(k<a<b<c>>>)(1, 2)(a);");
    CHECK(rewritten("k<(a > b), 1><<<1, 2>>>(a);") == "CUDASIM_LAUNCH(k<(a > b), 1>)(1, 2)(a);");
    CHECK(rewritten("if (x) k<<<1, 2>>>(); else j<<<3, 4>>>();") ==
          "if (x) CUDASIM_LAUNCH(k)(1, 2)(); else CUDASIM_LAUNCH(j)(3, 4)();");
    CHECK(rewritten("(up ? a : b)<<<1, 2>>>();") == "CUDASIM_LAUNCH((up ? a : b))(1, 2)();");
    CHECK(rewritten("kernels[i]<<<1, 2>>>();") == "CUDASIM_LAUNCH(kernels[i])(1, 2)();");
    CHECK(rewritten("k<<<(n + 255) >> 8, f(a >> b)>>>();") ==
          "CUDASIM_LAUNCH(k)((n + 255) >> 8, f(a >> b))();");
    CHECK(rewritten("k<<<1, /* >>> */ 2>>>();") == "CUDASIM_LAUNCH(k)(1, /* >>> */ 2)();");
    CHECK(rewritten("k<<<1, \">>>\"[0]>>>();") == "CUDASIM_LAUNCH(k)(1, \">>>\"[0])();");
    CHECK(rewritten("#define GO(k) k<<<1, 2>>>()\n") == "#define GO(k) CUDASIM_LAUNCH(k)(1, 2)()\n");
}

TEST_CASE("rewriter: what looks like a launch and is none") {
    check_unchanged("a << b; c >> 3; x = y << 1 >> 2;");
    check_unchanged("std::vector<std::vector<std::vector<int>>> v;");
    check_unchanged("bool p = a<b<c>>::value;");
    check_unchanged("s = \"k<<<1, 2>>>()\";");
    check_unchanged("s = \"a \\\" k<<<1, 2>>>()\";");
    check_unchanged("// k<<<1, 2>>>()\nint x;");
    check_unchanged("// goes on \\\n k<<<1, 2>>>()\nint x;");
    check_unchanged("/* k<<<1, 2>>>() \n k<<<1, 2>>>() */ int x;");
    check_unchanged("s = R\"(k<<<1, 2>>>() \" )\";");
    check_unchanged("s = u8R\"x(k<<<1, 2>>>() )\" )x\";");
    check_unchanged("char c = '\"'; int n = 1'000'000; char d = '\\'';");
    check_unchanged("a.operator<<<int>(b);");
    check_unchanged("std::ostream& operator<<<>(std::ostream&, T);");
    check_unchanged("s = \"__shared__ int a[3];\"; // __shared__ int b;\n");
    check_unchanged("int my__shared__x;");
}

TEST_CASE("rewriter: code after a literal is rewritten again") {
    CHECK(rewritten("s = R\"(\")\"; k<<<1, 2>>>();") == "s = R\"(\")\"; CUDASIM_LAUNCH(k)(1, 2)();");
    CHECK(rewritten("c = '\"'; k<<<1, 2>>>();") == "c = '\"'; CUDASIM_LAUNCH(k)(1, 2)();");
    CHECK(rewritten("n = 1'0; k<<<1, 2>>>(); m = 2'0;") == "n = 1'0; CUDASIM_LAUNCH(k)(1, 2)(); m = 2'0;");
}

TEST_CASE("rewriter: shared memory") {
    const auto shared = [](const std::string& name, const std::string& declaration,
                           const std::string& references) {
        return "CUDASIM_SHARED_BEGIN(" + name + ") " + declaration + "; CUDASIM_SHARED_END(" + name + ")" +
               references;
    };
    const auto reference = [](const std::string& memory, const std::string& name) {
        return " [[maybe_unused]] auto& " + name + " = cudasim_memory_" + memory + "." + name + ";";
    };
    CHECK(rewritten("__shared__ float a[256];") == shared("a", "float a[256]", reference("a", "a")));
    CHECK(rewritten("__shared__ std::array<int, 3> a;") ==
          shared("a", "std::array<int, 3> a", reference("a", "a")));
    CHECK(rewritten("__shared__ int a[N < 3 ? 1 : 2][M], b;") ==
          shared("a", "int a[N < 3 ? 1 : 2][M], b", reference("a", "a") + reference("a", "b")));
    CHECK(rewritten("__shared__ alignas(16) float a[4];") ==
          shared("a", "alignas(16) float a[4]", reference("a", "a")));
    CHECK(rewritten("static __shared__ int a;") == shared("a", "int a", reference("a", "a")));
    CHECK(rewritten("extern __shared__ float a[];") ==
          "float* const a = static_cast<float*>(::cudasim::dynamic_shared());");
    CHECK(rewritten("extern __shared__ __align__(16) unsigned char a[ ];") ==
          "unsigned char* const a = static_cast<unsigned char*>(::cudasim::dynamic_shared());");
}

TEST_CASE("rewriter: line numbers stay") {
    const std::string source =
        "a\nk<int,\n  3>\n<<<\n1,\n2\n>>>\n(x);\n__shared__\nint\na;\nextern\n__shared__\nint "
        "b[\n];\n/*\n*/\nlast\n";
    const std::string text = rewritten(source);
    CHECK(newlines(text) == newlines(source));
    CHECK(newlines(text.substr(text.find("last"))) == 1);
    CHECK(contains(text, "\n)\n(x)"));
}

TEST_CASE("rewriter: what it cannot read becomes an error at its line") {
    const auto check_rejected = [](const std::string& source, const std::string& message) {
        const std::string text = rewritten("first\n" + source + "\nlast\n");
        INFO(text);
        CHECK(contains(text, "\n#line 2\n#error \"" + message));
        const std::string after = text.substr(text.find("#error"));
        CHECK(contains(after, "\n#line 2\n"));  // what follows has its own numbers again
        CHECK(newlines(after.substr(after.find("#line 2\n") + 8)) == 2);
    };
    check_rejected("k<<<1, 2(x);", "<<< without >>>");
    check_rejected("= <<<1, 2>>>(x);", "there is no kernel's name before <<<");
    check_rejected("k<<<>>>(x);", "a launch needs its grid and block");
    check_rejected("k<<<1, 2>>>;", "a launch needs its arguments");
    check_rejected("__shared__ float (*a)[3];", "__shared__ needs the form");
    check_rejected("__shared__ a;", "__shared__ needs the form");
    check_rejected("extern __shared__ float a[][2];", "extern __shared__ needs the form");
}

TEST_CASE("rewriter: neighbours of a file are included from where it is") {
    const auto folder = std::filesystem::temp_directory_path() / "cudasim_rewriter_test";
    std::filesystem::create_directories(folder);
    for (const char* name : {"plain.h", "kernels.cuh"}) std::ofstream(folder / name) << "\n";
    const std::string path = (folder / "file.cu").string();
    const std::string source =
        "#include \"plain.h\"\n# include \"kernels.cuh\"\n#include \"missing.h\"\n#include <plain.h>\n";
    const std::string text = cudasim::rewrite(source, path);
    CHECK(contains(text, "#include \"" + (folder / "plain.h").string() + "\"\n"));
    CHECK(contains(text, "# include \"kernels.cuh\"\n"));  // its rewritten copy lies beside this file's
    CHECK(contains(text, "#include \"missing.h\"\n#include <plain.h>\n"));
    std::filesystem::remove_all(folder);
}
