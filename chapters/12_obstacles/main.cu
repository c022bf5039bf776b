#include "12_obstacles/fire_run.cuh"
#include "common/program.h"
#include "common/gl_context.h"
using namespace obstacles;
int main(int argc,char**argv){
  course::Program program("12_obstacles","Obstacles","x.");
  program.options.particles=20000; program.options.steps=0; program.scenes={"f"};
  return program.run(argc,argv,[&]{
    auto sc=flame_around_ball(program.options.particles,1);
    auto ctx=course::make_headless_context();
    FireRun run(sc,1);
    fire::SharedFire shared(sc.fire);
    fire::FireView view(sc.fire,program.options.width,program.options.height);
    int steps=int(sc.duration_s/sc.fire.dt_s);
    std::vector<course::Image> stills;
    for(int s=0;s<=steps;++s){
      if(s>= int(stills.size())*steps/8.0){ place_ball(view.renderer().stage, run.obstacles().now().obstacle[0].to_m); view.draw(shared, fire::camera_of(sc.fire)); auto im=view.image(); stills.push_back(course::half_size(im)); if(stills.size()==6) course::save_png(program.options.out/"still.png",im);}
      run.step(shared.map()); shared.unmap();
    }
    course::save_png(program.options.out/"lapse.png",course::contact_sheet(stills,3));
  });
}
