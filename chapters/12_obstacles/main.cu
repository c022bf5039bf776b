// quick trial
#include "12_obstacles/obstacle_view.cuh"
#include "12_obstacles/scene.cuh"
#include "common/gl_context.h"
#include "common/program.h"
using namespace obstacles;
int main(int argc, char** argv) {
    course::Program program("12_obstacles", "Obstacles", "x.");
    program.options.particles = 12000;
    program.options.steps = 0;
    for (auto& s : water_scenes()) program.scenes.push_back(s.water.name);
    return program.run(argc, argv, [&] {
        WaterSettings st;
        for (auto& s : water_scenes())
            if (s.water.name == program.options.scene) st.scene = s;
        st.particles = program.options.particles;
        st.measure_forces = true;
        auto ctx = course::make_headless_context();
        WaterRun run(st);
        ObstacleView view(run.size(), 0.55f * run.spacing_m(), run.low_m(), run.high_m(),
                          run.fastest_m_per_s(), program.options.width, program.options.height);
        int steps = program.options.steps ? program.options.steps : int(run.duration_s() / run.dt_s());
        std::vector<course::Image> stills;
        for (int s = 0; s <= steps; ++s) {
            if (s % 10 == 0) run.check_state(s);
            if (s >= int(stills.size()) * steps / 8.0) {
                view.draw(run.position(), run.velocity(), run.obstacles(),
                          first_view(run.low_m(), run.high_m()).camera());
                auto im = view.image();
                if (stills.size() == 3 || stills.size() == 5)
                    course::save_png(program.options.out / ("still" + std::to_string(stills.size()) + ".png"),
                                     im);
                stills.push_back(course::half_size(im));
                auto m = run.obstacles().motion(0);
                printf("t %g y %g vy %g  \n", s * run.dt_s(), m.position_m.y, m.velocity_m_per_s.y);
                auto x = run.water().positions().download();
                double deep = 0;
                int in = 0;
                for (auto& q : x) {
                    auto& o = run.obstacles().now().obstacle[0];
                    double d = signed_distance(o.solid, grid::xyz(q) - o.to_m);
                    if (d < -1e-5) {
                        in++;
                    }
                    deep = std::min(deep, d);
                }
                printf("inside %d deepest %g\n", in, deep);
            }
            run.step();
        }
        course::save_png(program.options.out / "lapse.png", course::contact_sheet(stills, 3));
    });
}
