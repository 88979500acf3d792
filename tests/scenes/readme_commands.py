"""How readme.py runs the commands of README.md and of the pages that are not run as they stand in the quick set. In all
lines the folder is readme.py's own, WORK in full, and build/burnish is the program under test."""

PYTHON, BURNISH = "build/venv/bin/python", "--burnish build/burnish"
FINE = "mpirun -n 2 build/burnish runs/pipe_pinch.yaml -o out/fine"
ROLLER = "mpirun -n 2 build/burnish roller.yaml -quiet -o"
STUDY = "--burnish build/burnish --out $WORK/out/study --quick"


def table(script, options):
    """A script of runs/records: what it runs on a coarse case."""
    return f"{PYTHON} scripts/{script}.py {BURNISH} --out $WORK/out/{script} --record $WORK/out/{script}.csv {options}"


def printed(script, record, options=""):
    """The same script prints the tables of its committed record."""
    return f"{PYTHON} scripts/{script}.py --print --record runs/records/{record}.csv {options}"


# The pages' commands install into the user's folders; here into one of the test's. What is tested is not built anew.
INSTALL = "test -x prefix/bin/burnish || make -o build/burnish -o build/libburnish.a install PREFIX=$WORK/prefix"

# Run in both sets, with other settings than the page shows
LIKE = {
    f"{PYTHON} scripts/reference.py": f"{PYTHON} scripts/reference.py --check {BURNISH}",
    f"{PYTHON} scripts/ring_table.py": f"{PYTHON} scripts/ring_table.py --help",
    f"{PYTHON} scripts/incompressible_table.py {BURNISH}": f"{PYTHON} scripts/incompressible_table.py --help",
    f"{PYTHON} scripts/o_ring_table.py {BURNISH}": f"{PYTHON} scripts/o_ring_table.py --help",
    f"{PYTHON} scripts/o_ring_calculix.py": f"{PYTHON} scripts/o_ring_calculix.py --help",
    f"{PYTHON} scripts/o_ring_calculix.py --solid": f"{PYTHON} scripts/o_ring_calculix.py --help",
    "build/tests/incompressible meshes runs/records/incompressible_rates.csv": "test -s "
    "runs/records/incompressible_rates.csv",
    "build/burnish -import tests/scenes/deck_stack.inp": "rm -f out/deck_stack.*; build/burnish -import "
    "tests/scenes/deck_stack.inp out/deck_stack.yaml",
    f"{PYTHON} -m http.server -d out/site": f"timeout 1 {PYTHON} -m http.server 0 -d out/site; test $? = 124",
    "mpirun -x OPENBLAS_CORETYPE": "mpirun -x OPENBLAS_CORETYPE -n 2 build/burnish -version",
    "make install": INSTALL,
    "pip install ./scripts": f"{PYTHON} -m pip install --no-index --no-deps --no-build-isolation --target $WORK/site "
    "./scripts",
    "make install PREFIX=$HOME/.local": INSTALL,
    "mpicc tests/library/library.c $(pkg-config --cflags --libs burnish) -o library":
    "PKG_CONFIG_PATH=$WORK/prefix/lib/pkgconfig; export PKG_CONFIG_PATH; "
    "mpicc tests/library/library.c $(pkg-config --cflags --libs burnish) -o library",
}

# Runs whose output no page shows: in the quick set these words behind them, which solve nothing, in the full set as
# they stand. The words before the command tell which.
CHECKED = {
    "build/burnish tests/jobs/": "-check",
    "build/burnish tests/scenes/pin_pressed.yaml": "-check",
    **{f"{ROLLER} out/{name}": "-check" for name in ("soft", "stiffest", "tilted", "interference")},
}

# Run in the full set only: as the page shows them (None), or with less to do
FULL = {
    "build/burnish -check bearing.yaml": None,
    "mpirun -n 2 build/burnish bearing.yaml": None,
    f"{PYTHON} scripts/render.py out/bearing --field pressure --arrows --up z --view=-35,40": None,
    f"{PYTHON} scripts/render.py out/roller --mirror x": None,
    f"{PYTHON} scripts/plot.py out/roller": None,
    f"{PYTHON} scripts/plot.py out/stiff out/roller": None,
    f"{ROLLER} out/adjusted -set \"contact.0.penalty={{adjust: true, g_min: 1e-4, g_max: 1e-2, unit: length}}\"": None,
    f"{ROLLER} out/augmented -set "
    "\"contact.0.penalty={augment: true, max_updates: 30, g_max: 1e-2, unit: length}\"": None,
    f"{ROLLER} out/first_order -set mesh.order=1": None,
    f"{ROLLER} out/facets -set contact.0.smoother=facet": None,
    f"{ROLLER} out/by_contact -set \"stepping={{control: contact, initial: 0.1, N_c: 4}}\"": None,
    f"{PYTHON} scripts/plot.py": f"{PYTHON} scripts/plot.py --help",
    f"{PYTHON} scripts/render.py": f"{PYTHON} scripts/render.py --help",
    f"{PYTHON} tests/layers.py build/obj": None,
    "make demo": f"{PYTHON} scripts/demo.py {BURNISH}",
    "make study": f"{PYTHON} scripts/study.py @runs/studies/effects.args {STUDY}",
    "make study QUICK=1": f"{PYTHON} scripts/study.py @runs/studies/hertz.args {STUDY}",
    "mpirun -n 2 build/burnish runs/pipe_pinch.yaml": None,
    f"{FINE} -set mesh.parameters.n_arc=48": f"{FINE} -set mesh.parameters.n_arc=48 -set mesh.parameters.n_len=2",
    "build/burnish -check runs/pipe_pinch.yaml": None,
    "build/burnish -mesh runs/pipe_pinch.yaml": None,
    f"{PYTHON} scripts/plot.py out/pipe_pinch": None,
    f"{PYTHON} scripts/plot.py out/pipe_pinch --x crown_gap": None,
    f"{PYTHON} scripts/report.py out/pipe_pinch --mirror xy": None,
    f"{PYTHON} scripts/plot.py out/stiff out/adjusted out/augmented": None,
    f"{PYTHON} scripts/render.py out/pipe_pinch --mirror xy": None,
    f"{PYTHON} scripts/render.py out/pipe_pinch --field uy --step 10 --view=60,15": None,
    f"{PYTHON} scripts/render.py out/pipe_pinch --cut z=100 --undeformed -o out/cut.png": None,
    f"{PYTHON} scripts/render.py out/pipe_pinch --field pressure --arrows --view=-40,-30 -o out/arrows.png": None,
    "mpirun -n 64 build/burnish scene.yaml -o out/long -set output.checkpoint=5 -time_limit 43000":
    "mpirun -n 2 build/burnish runs/pipe_pinch.yaml -o out/long -set output.checkpoint=5 -time_limit 2; test $? = 3",
    "mpirun -n 32 build/burnish -restart out/long": "mpirun -n 1 build/burnish -restart out/long",
    "mpirun -n 2 build/burnish -restart out/failed -set stepping.dt_min=1e-7":
    'mpirun -n 2 build/burnish runs/slide_cylinder.yaml -o out/failed -set solver.max_iterations=1 '
    '-set "stepping={control: fixed, initial: 0.1, dt_min: 0.06, damping: none}"; test $? = 2 && '
    "mpirun -n 2 build/burnish -restart out/failed -set stepping.dt_min=1e-7 -set solver.max_iterations=30",
    "ctest --test-dir build/ctest -R scene-lame --output-on-failure":
    "ctest --test-dir build/ctest -R scene-lame-plane_strain-1-0-np1 --output-on-failure",
    f"{PYTHON} scripts/study.py runs/hertz_line.yaml --vary contact.0.smoother=facet,diffuse "
    "--vary mesh.parameters.h=0.8,0.4,0.2 --measure peak_pressure --reference finest":
    f"{PYTHON} scripts/study.py runs/hertz_line.yaml --vary contact.0.smoother=facet,diffuse "
    f"--vary mesh.parameters.h=0.8,0.4,0.2 --measure peak_pressure --reference finest {STUDY}",
    f"{PYTHON} scripts/ring_pictures.py": f"{PYTHON} scripts/ring_pictures.py {BURNISH} --out $WORK/out/rings",
    f"{PYTHON} scripts/seal_pictures.py": f"{PYTHON} scripts/seal_pictures.py {BURNISH} --out $WORK/out/seal",
    f"{PYTHON} scripts/ring_table.py plane": table("ring_table", "plane"),
    f"{PYTHON} scripts/ring_table.py plane12 matching solid spheres": printed("ring_table", "formulations", "plane12"),
    f"{PYTHON} scripts/ring_table.py --record runs/records/offsets.csv offsets":
    printed("ring_table", "offsets", "offsets"),
    f"{PYTHON} scripts/patch_table.py": printed("patch_table", "patch"),
    f"{PYTHON} scripts/axis_table.py": printed("axis_table", "axis"),
    f"{PYTHON} scripts/drawn_table.py --record runs/records/drawn.csv": printed("drawn_table", "drawn"),
    f"{PYTHON} scripts/friction_table.py --record runs/records/friction.csv": printed("friction_table", "friction"),
    f"{PYTHON} scripts/o_ring_3d_table.py --record runs/records/o_ring_3d_pressure.csv":
    printed("o_ring_3d_table", "o_ring_3d_pressure"),
    f"{PYTHON} scripts/friction_solver_table.py --record runs/records/friction_solver.csv":
    printed("friction_solver_table", "friction_solver"),
    f"{PYTHON} scripts/plot.py out/press_fit": None,
    f"{PYTHON} scripts/rubber_jobs_table.py --record runs/records/rubber_jobs.csv":
    printed("rubber_jobs_table", "rubber_jobs"),
    f"{PYTHON} scripts/ball_table.py": printed("ball_table", "ball"),
    f"{PYTHON} scripts/forming_table.py": printed("forming_table", "forming"),
    f"{PYTHON} scripts/michell_table.py": printed("michell_table", "michell"),
    f"{PYTHON} scripts/penalty_table.py --record runs/records/penalty.csv": printed("penalty_table", "penalty"),
    f"{PYTHON} scripts/adaptive_table.py --record runs/records/adaptive.csv --only bracket hertz_line ring_in_ring "
    '"hertz_line patch" hertz_sphere "hertz_sphere patch"':
    printed("adaptive_table", "adaptive"),
    f"{PYTHON} scripts/error_table.py --record runs/records/error.csv": printed("error_table", "error"),
    f"{PYTHON} scripts/sensitivity_table.py --record runs/records/sensitivity.csv":
    printed("sensitivity_table", "sensitivity"),
    f"{PYTHON} scripts/hertz_table.py": printed("hertz_table", "hertz"),
    f"{PYTHON} tests/jobs/run.py --record runs/records/jobs.csv":
    f"{PYTHON} tests/jobs/run.py {BURNISH} --out $WORK/out/jobs --job lip_seal --record $WORK/out/jobs.csv",
    f"{PYTHON} scripts/formulation_table.py --record runs/records/paper_formulations.csv":
    table("formulation_table", "'cup, N_c'"),
    f"{PYTHON} scripts/formulation_table.py --offsets --record runs/records/paper_offsets.csv":
    printed("formulation_table", "paper_offsets", "--offsets"),
    f"{PYTHON} scripts/thin_wall_table.py --record runs/records/thin_walls.csv": table("thin_wall_table", "cook"),
    f"{PYTHON} scripts/smoother_table.py --burnish build/burnish --repeats 5":
    f"{PYTHON} scripts/smoother_table.py --table runs/records/smoothers.csv",
    f"{PYTHON} scripts/surface_table.py --burnish ../before/build/burnish build/burnish --names before after":
    f"{PYTHON} scripts/surface_table.py --table runs/records/surface.csv",
    f"{PYTHON} scripts/physics_table.py --record runs/records/physics.csv": printed("physics_table", "physics"),
    f"{PYTHON} scripts/version_table.py --before ../before --record runs/records/versions.csv":
    printed("version_table", "versions"),
    f"{PYTHON} scripts/augment_table.py --record runs/records/augment.csv": table("augment_table", "rings"),
    f"{PYTHON} scripts/paper.py -j 1 --record runs/records/paper":
    f"{PYTHON} scripts/paper.py cup_flattening -j 1 --quick {BURNISH} --out $WORK/out/paper",
    f"{PYTHON} scripts/compare_calculix.py --record runs/records/calculix.csv":
    f"{PYTHON} scripts/compare_calculix.py --table runs/records/calculix.csv",
    f"{PYTHON} scripts/compare_calculix.py --record runs/records/calculix_friction.csv \"mu \"":
    f"{PYTHON} scripts/compare_calculix.py --table runs/records/calculix_friction.csv",
    f"{PYTHON} scripts/compare_calculix.py --record runs/records/calculix_laws.csv yields rubber":
    f"{PYTHON} scripts/compare_calculix.py --table runs/records/calculix_laws.csv",
    f"{PYTHON} scripts/calculix_table.py --repeats 1 --limit 150 --record runs/records/calculix_ratios.csv":
    printed("calculix_table", "calculix_ratios"),
    f"{PYTHON} scripts/figures_table.py --repeats 8 --record runs/records/figures.csv":
    printed("figures_table", "figures"),
    f"{PYTHON} scripts/fit_rubber.py runs/rubber/treloar": None,
    f"{PYTHON} scripts/wish_table.py --record runs/records/wish.csv": printed("wish_table", "wish"),
    f"{PYTHON} scripts/deck_table.py --record runs/records/decks.csv": printed("deck_table", "decks"),
    f"{PYTHON} scripts/all_table.py --record runs/records/all.csv": printed("all_table", "all"),
    f"{PYTHON} scripts/overhead_table.py --record runs/records/all_overhead.csv": printed("overhead_table",
                                                                                      "all_overhead"),
    f"{PYTHON} scripts/search_table.py --record runs/records/search.csv": printed("search_table", "search"),
    f"{PYTHON} scripts/ranks_table.py --record runs/records/ranks.csv": printed("ranks_table", "ranks"),
    f"{PYTHON} scripts/mesh_memory_table.py --record runs/records/mesh_memory.csv":
    f"{PYTHON} scripts/mesh_memory_table.py --print --record runs/records/mesh_memory.csv",
    f"{PYTHON} tests/hard/run.py --group guards":
    f"{PYTHON} tests/hard/run.py {BURNISH} --out $WORK/out/hard --case 'corner of two walls' --ranks 1",
    f"{PYTHON} tests/hard/run.py --record runs/records/hard.csv":
    f"{PYTHON} tests/hard/run.py {BURNISH} --out $WORK/out/hard --case 'five nodes' --ranks 1 "
    "--record $WORK/out/hard.csv",
}

# Commands that no test runs: the reason, and what the full set checks instead
DEPS = "installs packages, as root or with sudo"
ITSELF = "runs this test itself"
QUEUE = "there is no queue here; restart.py runs the chain of jobs without one"
NOT_HERE = {
    "make deps": (DEPS, "bash -n scripts/deps.sh && make -n deps"),
    "make deps demo": (DEPS, "make -n deps demo >/dev/null"),
    "make deps check": (DEPS, "make -n deps check >/dev/null"),
    "make check": (ITSELF, "make -n check >/dev/null"),
    "make test": (ITSELF, "make -n test >/dev/null"),
    "make SANITIZE=1 check": (ITSELF, "make -n SANITIZE=1 check >/dev/null"),
    f"{PYTHON} tests/scenes/readme.py --burnish build/burnish --ranks 1 --out out/readme --part full --update yes":
    (ITSELF, f"{PYTHON} tests/scenes/readme.py --help"),
    "make ARCH=x86-64-v3": ("compiles everything anew", "make -n ARCH=x86-64-v3 >/dev/null"),
    "make format": ("changes the sources", "make -n format >/dev/null"),
    "make bench":
    ("takes minutes of an idle machine; scaling.py runs its script", "bash -n scripts/bench.sh"),
    "make bench LARGE=1": ("takes an hour of an idle machine", "make -n bench LARGE=1 >/dev/null"),
    "make fuzz":
    ("wants clang and 20 minutes; fuzz-scene and fuzz-mesh replay what it found", "bash -n scripts/fuzz.sh"),
    "make valgrind":
    ("wants valgrind, which make deps does not install", "bash -n scripts/valgrind.sh && make -n valgrind"),
    "scripts/portability.sh PREFIX": ("wants a second PETSc", "bash -n scripts/portability.sh"),
    "module use scripts/packaging/modules": ("wants Environment Modules", "test -d scripts/packaging/modules"),
    "module load burnish": ("wants Environment Modules", "test -f scripts/packaging/modules/burnish/0.1.0"),
    "module load gcc openmpi petsc metis gmsh cmake python":
    ("wants a cluster", "grep -qF 'module load gcc openmpi petsc metis gmsh cmake python' scripts/deps.sh"),
    "spack install petsc+mumps+hdf5+metis gmsh libyaml cjson muparser cmocka cmake":
    ("wants spack",
     "grep -qF 'spack install petsc+mumps+hdf5+metis gmsh libyaml cjson muparser cmocka cmake' scripts/deps.sh"),
    "sbatch runs/batch/slurm.sh runs/pipe_pinch.yaml out/pipe_pinch":
    (QUEUE, "bash -n runs/batch/slurm.sh && bash -n runs/batch/chain.sh && test -f runs/pipe_pinch.yaml"),
    "qsub -v SCENE=runs/pipe_pinch.yaml,DIR=out/pipe_pinch runs/batch/pbs.sh": (QUEUE, "bash -n runs/batch/pbs.sh"),
    "sbatch --array=0-3 runs/batch/slurm_study.sh runs/pipe_pinch.yaml --vary contact.0.degree=2,4 "
    "--measure plate_force --reference finest":
    (QUEUE, "bash -n runs/batch/slurm_study.sh && bash -n runs/batch/pbs_study.sh"),
}
