#include "ex3_fit_camera.h"

#include "tests/support/course_test.h"

namespace {

using interop::Box;

course::Camera looking_from(glm::vec3 direction, float field_of_view_rad = 0.7f) {
    course::Camera camera;
    camera.eye_m = direction;
    camera.target_m = {0, 0, 0};
    camera.field_of_view_rad = field_of_view_rad;
    return camera;
}

/// How far out the outermost corner is once the camera stands where the learner says: 1 is the picture's
/// edge.
float outermost(const Box& box, course::Camera camera, float aspect) {
    const float distance_m = interop::fitting_distance_m(box, camera, aspect);
    if (!(distance_m > 0)) return course::kTodo;
    camera.eye_m = box.centre_m() + distance_m * glm::normalize(camera.eye_m - camera.target_m);
    camera.target_m = box.centre_m();
    const glm::mat4 to_clip = camera.projection(aspect) * camera.view();
    float most = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec4 clip = to_clip * glm::vec4(corner & 1 ? box.high_m.x : box.low_m.x,
                                                   corner & 2 ? box.high_m.y : box.low_m.y,
                                                   corner & 4 ? box.high_m.z : box.low_m.z, 1);
        if (!(clip.w > 0)) return 1e6f;  // behind the eye: farther out than anything in front of it
        most = std::max({most, std::abs(clip.x / clip.w), std::abs(clip.y / clip.w)});
    }
    return most;
}

void check_fits(const Box& box, const course::Camera& camera, float aspect) {
    CAPTURE(aspect);
    // 1e-4: a twentieth of a pixel in a picture 1000 pixels wide, and far more than fp32 loses here
    CHECK(std::abs(outermost(box, camera, aspect) - 1) <= 1e-4f);
}

}  // namespace

TEST_CASE("a cube from in front: its near face fills the picture") {
    course::set_hint(1);
    const Box cube{{-1, -1, -1}, {1, 1, 1}};
    const course::Camera camera =
        looking_from({0, 0, 1}, 1.5707963f);  // 90 degrees: the tangent of half is 1
    CHECK(interop::fitting_distance_m(cube, camera, 1) == doctest::Approx(2).epsilon(1e-4));
    CHECK(interop::fitting_distance_m(cube, camera, 2) == doctest::Approx(2).epsilon(1e-4));
    CHECK(interop::fitting_distance_m(cube, camera, 0.5f) == doctest::Approx(3).epsilon(1e-4));
}

TEST_CASE("wide and tall boxes in wide and tall pictures") {
    course::set_hint(3);
    const course::Camera camera = looking_from({0, 0, 1});
    for (const float aspect : {16.0f / 9, 1.0f, 0.5f}) {
        check_fits({{-3, -0.5f, -0.5f}, {3, 0.5f, 0.5f}}, camera, aspect);
        check_fits({{-0.5f, -3, -0.5f}, {0.5f, 3, 0.5f}}, camera, aspect);
    }
}

TEST_CASE("seen at an angle, and away from the origin") {
    course::set_hint(2);
    for (const glm::vec3 direction :
         {glm::vec3(1, 0.5f, 2), glm::vec3(-3, 1, 0.2f), glm::vec3(0.3f, 5, 0.4f)})
        check_fits({{10, -2, 4}, {14, -1, 5}}, looking_from(direction), 16.0f / 9);
}

TEST_CASE("a deep box seen along its depth") {
    course::set_hint(2);
    check_fits({{-0.2f, -0.2f, -10}, {0.2f, 0.2f, 10}}, looking_from({0, 0, 1}), 1);
    check_fits({{-0.2f, -0.2f, -10}, {0.2f, 0.2f, 10}}, looking_from({0, 0.1f, 1}), 1.5f);
}
