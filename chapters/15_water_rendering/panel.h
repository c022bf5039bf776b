/// @file
/// What can be switched while the window is open: a panel where Dear ImGui is installed, keys everywhere.
#pragma once
#include <cstdio>

#include "15_water_rendering/water_view.cuh"
#include "common/gl_gui.h"
#ifdef COURSE_WITH_GUI
#include <imgui.h>
#endif

namespace water {

/// What a window shows, as its user wants it.
struct Wishes {
    Look look;
    bool paused = false;
    glm::vec3 ball_m{0};
};

/// Do both looks need the same view? Exposure and march can change without a new one.
inline bool same_view(const Look& a, const Look& b) {
    return a.drawing == b.drawing && a.inside == b.inside && a.schlick == b.schlick &&
           a.caustics == b.caustics;
}

/// Keys 1 to 4.
inline void follow_keys(Wishes& wishes, const course::WindowEvents& events) {
    constexpr Drawing kOrder[] = {Drawing::points, Drawing::spheres, Drawing::screen_space, Drawing::surface};
    if (events.digit >= 1 && events.digit <= 4) wishes.look.drawing = kOrder[events.digit - 1];
    if (events.pause) wishes.paused = !wishes.paused;
}

#ifdef COURSE_WITH_GUI
//! [panel]
/// Declares the panel of this frame, between Gui::begin() and Gui::end().
inline void draw_panel(Wishes& wishes, const Stage& stage, const PassClock& clock, double step_ms) {
    ImGui::SetNextWindowPos({12, 12}, ImGuiCond_FirstUseEver);
    ImGui::Begin("Water", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushItemWidth(130);
    int drawing = int(wishes.look.drawing), inside = int(wishes.look.inside);
    ImGui::Combo("drawn as", &drawing, "points\0spheres\0screen space\0surface\0");
    wishes.look.drawing = Drawing(drawing);
    if (wishes.look.drawing == Drawing::surface) {
        ImGui::Combo("light inside", &inside, "marched\0thickness\0straight\0");
        wishes.look.inside = Inside(inside);
        ImGui::Checkbox("caustics", &wishes.look.caustics);
    }
    if (wishes.look.drawing >= Drawing::screen_space) ImGui::Checkbox("Schlick", &wishes.look.schlick);
    ImGui::Checkbox("pause", &wishes.paused);
    if (stage.ball.radius_m > 0) {
        ImGui::SliderFloat("ball x (m)", &wishes.ball_m.x, stage.tank_low_m.x, stage.tank_high_m.x);
        ImGui::SliderFloat("ball y (m)", &wishes.ball_m.y, stage.tank_low_m.y, stage.tank_high_m.y);
        ImGui::SliderFloat("ball z (m)", &wishes.ball_m.z, stage.tank_low_m.z, stage.tank_high_m.z);
    }
    ImGui::Text("step %.1f ms", step_ms);
    for (const auto& [pass, milliseconds] : clock.passes())
        ImGui::Text("%s %.1f ms", pass.c_str(), milliseconds);
    ImGui::Text("picture %.1f ms", clock.total_ms());
    ImGui::PopItemWidth();
    ImGui::End();
}
//! [panel]
#else
inline void draw_panel(Wishes&, const Stage&, const PassClock&, double) {}
#endif

/// The same times in the window's title, for where there is no panel.
inline std::string title(const std::string& scene, const PassClock& clock, double step_ms) {
    char text[160];
    std::snprintf(text, sizeof text, "%s: step %.1f ms, picture %.1f ms", scene.c_str(), step_ms,
                  clock.total_ms());
    return text;
}

}  // namespace water
