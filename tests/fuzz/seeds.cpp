// Writes what each fuzz target begins with: <folder>/<target>/ and a dictionary, <folder>/case.dict.

#include <set>
#include <string>

#include "bedload/case/parameters.hpp"
#include "bedload/output/files.hpp"
#include "bedload/output/output.hpp"
#include "tests/case/support.hpp"
#include "tests/geometry/mesh_support.hpp"
#include "tests/output/fake_simulation.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

/// The repository's own cases, whose names say where they come from.
void write_cases(const fs::path& folder) {
  write_file(folder / "dam.toml", test::kCase);
  for (const auto& entry : fs::recursive_directory_iterator(BL_SOURCE_DIR "/cases")) {
    const fs::path file = entry.path();
    if (file.extension() != ".toml" || file.filename().string().starts_with("expect")) continue;
    fs::copy_file(file, folder / (file.parent_path().filename().string() + "_" + file.filename().string()),
                  fs::copy_options::overwrite_existing);
  }
}

/// Keys and the names that may be chosen.
void write_dictionary(const fs::path& file) {
  std::set<std::string> words;
  for (const ParameterRow& row : parameter_table()) {
    words.insert(row.key.substr(row.key.rfind('.') + 1));
    words.insert(row.key.substr(0, row.key.rfind('.')));
    for (const Choice& choice : row.choices) words.insert(choice.name);
  }
  std::string text;
  for (const std::string& word : words) text += "\"" + word + "\"\n";
  write_file(file, text);
}

void write_foreign_cases(const fs::path& folder) {
  write_file(folder / "dam.xml",
             R"xml(<case><casedef><constantsdef><gravity x="0" y="0" z="-9.81" /></constantsdef>
<geometry><definition dp="0.01"><pointmin x="0" y="0" z="0" /><pointmax x="1" y="1" z="1" /></definition>
<commands><mainlist><newvar a="2*Dp" /><setmkfluid mk="0" />
<drawbox><boxfill>solid</boxfill><point x="0" y="0" z="0" /><size x="#a*10" y="max(a, 0.2)" z="0.2" /></drawbox>
<setmkbound mk="1" /><rotate ang="20" x="0" y="1" z="0" />
<drawcylinder radius="0.1"><point x="0.5" y="0" z="0" /><point x="0.5" y="0" z="1" /></drawcylinder>
</mainlist></commands></geometry>
<motion><objreal ref="1"><begin mov="1" start="0" /><mvrot id="1" duration="1" next="2"><vel ang="90" />
<axisp1 x="0" y="0" z="0" /><axisp2 x="0" y="0" z="1" /></mvrot><wait id="2" duration="1" next="1" /></objreal></motion>
</casedef><execution><parameters><parameter key="TimeMax" value="1" /></parameters></execution></case>)xml");
  write_file(folder / "in.box", R"(units si
variable r equal 0.002*2
region b block 0 1 0 1 0 1
create_box 1 b
pair_style gran model hertz tangential history rolling_friction epsd2
timestep 1e-5
fix m all property/global youngsModulus peratomtype 5e6
fix z all wall/gran model hertz primitive type 1 zcylinder 0.5 0.5 0.5
fix t all particletemplate/sphere 1 atom_type 1 density constant 2500 radius constant ${r}
fix d all particledistribution/discrete 1 1 t 1.0
fix i all insert/pack seed 1 distributiontemplate d particles_in_region 10 region b
run 1000
)");
}

void write_tables(const fs::path& folder) {
  write_file(folder / "grains.csv",
             "# beads\nx [m],y [m],z [m],d [m],vx [m/s],vy,vz\n0.01,2e-3,+0.01,0.004,0,0,-1\n");
  write_file(folder / "fluid.csv", "\"id\",\"x\",\"y\",\"z\",\"radius\"\r\n1,0,0,0,0.002\r\n");
  write_file(folder / "gate.csv",
             "# measured\ntime [s],z [m],x,ry [deg]\r\n\r\n0,0,0,0\r\n 0.1 , 2e-3,+0.5,-90\n");
  write_file(folder / "turn.csv",
             "t,x,y,z,rx,ry,rz\n0,0,0,0,0,0,0\n0.125,0.1,0,0,0,0,30\n0.3,0.2,0,0,0,0,33.3\n");
}

/// Each behind the byte that says what it is: 0 STL, 1 OBJ, 2 PLY, 3 more to repair it; 6 a map, 7 an open
/// OBJ.
void write_meshes(const fs::path& folder) {
  const auto add = [&](const std::string& name, char kind, auto make) {
    const fs::path made = folder / name;
    make(made, test::cube());
    const std::string bytes = read_file(made);
    write_file(made, kind + bytes);
    write_file(folder / ("repair_" + name), char(kind + 3) + bytes);
  };
  add("binary.stl", 0, test::write_stl);
  add("ascii.stl", 0, test::write_ascii_stl);
  add("cube.obj", 1, test::write_obj);
  add("cube.ply", 2, test::write_ply);
  write_file(folder / "polygons.obj",
             "\1v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1 4/1/1\n");
  write_file(folder / "little.ply", "\2" + test::binary_ply(false));
  write_file(folder / "big.ply", "\2" + test::binary_ply(true));
  write_file(folder / "map.asc",
             "\6ncols 3\nnrows 2\nxllcorner 0\nyllcenter 0.5\ncellsize 2\nNODATA_value -9\n3 4 6\n1 2 3\n");
  write_file(folder / "floor.obj", "\7v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
  write_file(folder / "hopper.stl", '\0' + read_file(BL_SOURCE_DIR "/cases/hopper/hopper.stl"));
}

/// A checkpoint, a summary and orders to change a checkpoint.
void write_checkpoints(const fs::path& folder) {
  testing::FakeSimulation simulation;
  write_state(folder / "state.h5", simulation.save(), testing::fake_config());
  const test::TemporaryFolder results;
  RunOutput output(results / "run", testing::fake_config(), {}, "1.0");
  output.write(simulation, simulation.info());
  output.finish(simulation, "completed", {});
  fs::copy_file(results / "run/summary.json", folder / "summary.json", fs::copy_options::overwrite_existing);
  for (int k = 0; k < 32; ++k)
    write_file(folder / ("orders_" + std::to_string(k)), std::string(std::size_t(3 + k), char(k * 37)));
}

}  // namespace
}  // namespace bedload

int main(int, char** argv) {
  using namespace bedload;
  const fs::path folder = argv[1];
  for (const char* target : {"case", "convert", "table", "mesh", "checkpoint"})
    fs::create_directories(folder / target);
  write_cases(folder / "case");
  write_dictionary(folder / "case.dict");
  write_foreign_cases(folder / "convert");
  write_tables(folder / "table");
  write_meshes(folder / "mesh");
  write_checkpoints(folder / "checkpoint");
}
