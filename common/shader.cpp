#include "common/shader.h"

#include <cstdlib>
#include <fstream>
#include <glm/gtc/type_ptr.hpp>
#include <sstream>

#include "common/errors.h"

namespace course {

namespace {

std::string read_file(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::ostringstream text;
    if (!file || !(text << file.rdbuf()))
        throw BadInput("cannot read the shader " + path.string() +
                       " (the environment variable COURSE_SHADER_DIR names the folder)");
    return text.str();
}

// The driver's message, each line indented so that it reads as part of ours.
std::string indented(std::string log) {
    while (!log.empty() && (log.back() == '\0' || log.back() == '\n')) log.pop_back();
    std::string out = "\n    ";
    for (const char c : log) out += c == '\n' ? std::string("\n    ") : std::string(1, c);
    return out;
}

// Deletes the shader object once the program is linked; the program keeps what it needs.
struct CompiledShader {
    GLuint id;
    explicit CompiledShader(GLenum stage) : id(glCreateShader(stage)) {}
    CompiledShader(const CompiledShader&) = delete;
    CompiledShader& operator=(const CompiledShader&) = delete;
    ~CompiledShader() { glDeleteShader(id); }
};

void attach(GLuint program, const std::filesystem::path& path) {
    const std::string text = read_file(path);
    const CompiledShader shader(path.extension() == ".vert" ? GL_VERTEX_SHADER : GL_FRAGMENT_SHADER);
    const char* source = text.c_str();
    glShaderSource(shader.id, 1, &source, nullptr);
    glCompileShader(shader.id);
    GLint good = 0;
    glGetShaderiv(shader.id, GL_COMPILE_STATUS, &good);
    if (!good) {
        GLint length = 0;
        glGetShaderiv(shader.id, GL_INFO_LOG_LENGTH, &length);
        std::string log(std::size_t(length), '\0');
        glGetShaderInfoLog(shader.id, length, nullptr, log.data());
        throw BadInput("the shader " + path.string() + " does not compile:" + indented(log));
    }
    glAttachShader(program, shader.id);
}

}  // namespace

std::filesystem::path shader_folder() {
    const char* folder = std::getenv("COURSE_SHADER_DIR");
    return folder && *folder ? folder : COURSE_SHADER_DIR;
}

ShaderProgram::ShaderProgram(const std::vector<std::string>& files) {
    std::string names;
    for (const std::string& file : files) {
        attach(program_.id(), shader_folder() / file);
        names += (names.empty() ? "" : ", ") + file;
    }
    glLinkProgram(program_.id());
    GLint good = 0;
    glGetProgramiv(program_.id(), GL_LINK_STATUS, &good);
    if (!good) {
        GLint length = 0;
        glGetProgramiv(program_.id(), GL_INFO_LOG_LENGTH, &length);
        std::string log(std::size_t(length), '\0');
        glGetProgramInfoLog(program_.id(), length, nullptr, log.data());
        throw BadInput("the shaders " + names + " do not link:" + indented(log));
    }
}

void ShaderProgram::set(const char* name, int value) const {
    glUniform1i(location(name), value);
}
void ShaderProgram::set(const char* name, float value) const {
    glUniform1f(location(name), value);
}
void ShaderProgram::set(const char* name, const glm::vec2& value) const {
    glUniform2fv(location(name), 1, glm::value_ptr(value));
}
void ShaderProgram::set(const char* name, const glm::vec3& value) const {
    glUniform3fv(location(name), 1, glm::value_ptr(value));
}
void ShaderProgram::set(const char* name, const glm::vec4& value) const {
    glUniform4fv(location(name), 1, glm::value_ptr(value));
}
void ShaderProgram::set(const char* name, const glm::mat4& value) const {
    glUniformMatrix4fv(location(name), 1, GL_FALSE, glm::value_ptr(value));
}
void ShaderProgram::set(const char* name, const std::array<glm::vec3, 4>& values) const {
    glUniform3fv(location(name), GLsizei(values.size()), glm::value_ptr(values.front()));
}

}  // namespace course
