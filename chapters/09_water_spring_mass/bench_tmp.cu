#include "09_water_spring_mass/study_rivals.cuh"
#include <sys/resource.h>
using namespace spring_mass;
static double cpu(){ rusage u; getrusage(RUSAGE_SELF,&u); return u.ru_utime.tv_sec+u.ru_utime.tv_usec*1e-6+u.ru_stime.tv_sec+u.ru_stime.tv_usec*1e-6; }
int main(int c, char** v){
  std::uint32_t n=std::atoi(v[1]); int steps=std::atoi(v[2]); float skin=std::atof(v[3]); int lmp=c>4?std::atoi(v[4]):0;
  Bed bed=make_bed(n,400);
  Marbles m(bed.material,bed.box,bed.position,bed.velocity,skin);
  Summarizer s(n); Summary a=s(m);
  int lists=m.lists_made();
  for(int k=0;k<3;++k){
  auto t0=std::chrono::steady_clock::now(); double c0=cpu();
  for(int i=0;i<steps;++i) m.step(bed.dt_s);
  double w=std::chrono::duration<double>(std::chrono::steady_clock::now()-t0).count(), cc=cpu()-c0;
  std::printf("n %u skin %g: wall %.1f M/s, cpu %.2f M/s per core; contacts %.2f -> %.2f, lists every %.1f steps; speed %g\n",n,skin,1e-6*n*steps/w,1e-6*n*steps/cc,a.contacts/n,s(m).contacts/n,double(steps)/(m.lists_made()-lists), s(m).highest_speed);
  lists=m.lists_made();
  }
  if(lmp){ LammpsScene sc; sc.material=in_double(bed.material); sc.low_m={0,0,0}; sc.high_m={bed.box.high_m.x,bed.box.high_m.y,bed.box.high_m.z};
   for(auto&p:bed.position) sc.position.push_back({p.x,p.y,p.z}); for(auto&p:bed.velocity) sc.velocity.push_back({p.x,p.y,p.z});
   sc.dt_s=bed.dt_s; sc.steps=steps; sc.skin_m=skin*bed.material.diameter_m;
   std::filesystem::create_directories("/tmp/sm_lmp");
   for(int r=1;r<=lmp;++r){ double c0; rusage u; getrusage(RUSAGE_CHILDREN,&u); c0=u.ru_utime.tv_sec+u.ru_utime.tv_usec*1e-6; auto ans=run_lammps(sc,"/tmp/sm_lmp",r); getrusage(RUSAGE_CHILDREN,&u); double c1=u.ru_utime.tv_sec+u.ru_utime.tv_usec*1e-6;
   std::printf("lammps %d ranks: wall %.1f M/s; cpu incl setup %.2f M/s\n",r,1e-6*n*steps/ans.seconds,1e-6*n*steps/(c1-c0)); }
  }
}
