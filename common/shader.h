/// @file
/// GLSL programs made from files in the shader folder.
#pragma once
#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "common/gl_objects.h"

namespace course {

/// Where the GLSL files are: the environment variable COURSE_SHADER_DIR, else the folder known when this was
/// built. An absolute path, so that a program runs from any working directory.
std::filesystem::path shader_folder();

/// A linked program. Files named .vert are vertex shaders, .frag fragment shaders; several of one kind share
/// their functions, as C++ files do.
class ShaderProgram {
  public:
    /// @throws BadInput if a file can't be read or does not compile (with its name and the driver's message)
    explicit ShaderProgram(const std::vector<std::string>& files);

    /// Draw calls and set() work on the program used last.
    void use() const { glUseProgram(program_.id()); }

    // Values of uniforms. A name that the shader does not use is no error: drivers remove unused uniforms.
    void set(const char* name, int value) const;
    void set(const char* name, float value) const;
    void set(const char* name, const glm::vec2& value) const;
    void set(const char* name, const glm::vec3& value) const;
    void set(const char* name, const glm::vec4& value) const;
    void set(const char* name, const glm::mat4& value) const;
    void set(const char* name, const std::array<glm::vec3, 4>& values) const;

  private:
    GLint location(const char* name) const { return glGetUniformLocation(program_.id(), name); }
    GlObject<GlKind::program> program_;
};

}  // namespace course
