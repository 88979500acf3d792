"""Recipe for spack: put the folder `spack` into a repository of recipes (packages/burnish), or take it from here with
`spack dev-build burnish@main` in the sources. Untried."""
from spack.package import *


class Burnish(MakefilePackage):
    """Contact of deformable bodies, from a scene file to results, in parallel on PETSc."""

    version("main", branch="main")

    depends_on("c", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("mpi")
    depends_on("petsc@3.18:+mpi+mumps+hdf5+metis~complex+double")
    depends_on("hdf5+mpi")
    depends_on("mumps+mpi")
    depends_on("metis@5:")
    depends_on("libyaml")
    depends_on("cjson")
    depends_on("muparser")
    depends_on("gmsh", type="run")
    depends_on("python@3.9:", type="run")
    depends_on("py-numpy", type="run")
    depends_on("py-h5py", type="run")
    depends_on("py-matplotlib", type="run")

    def setup_build_environment(self, env):
        env.set("PETSC_DIR", self.spec["petsc"].prefix)

    def build(self, spec, prefix):
        make("CC=" + spec["mpi"].mpicc)

    def install(self, spec, prefix):
        make("CC=" + spec["mpi"].mpicc, "PREFIX=" + prefix, "install")
