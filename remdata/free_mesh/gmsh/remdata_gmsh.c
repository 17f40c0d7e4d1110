/* remdata_gmsh: what Gmsh makes of a script, in a process of its own.
 *
 *   remdata_gmsh SCRIPT.geo MESH.msh
 *
 * remdata writes the script and reads the mesh; a crash or an endless loop of the library ends this process and not remdata.
 * Gmsh's own messages go to the standard output. Ends with 0 and a mesh, or with 3 and no file; with 2 where it was called wrong.
 */
#include <gmshc.h>
#include <stdio.h>
#include <stdlib.h>

enum { done = 0, wrong_call = 2, no_mesh = 3 };

/* The error of a call ends the program. */
static void check(int failed, const char *what) {
  if (!failed) return;
  fprintf(stderr, "Gmsh cannot %s\n", what);
  exit(no_mesh);
}

int main(int count, char **words) {
  char *name[] = {"remdata_gmsh", NULL};
  int failed = 0;

  if (count != 3) {
    fprintf(stderr, "usage: remdata_gmsh SCRIPT.geo MESH.msh\n");
    return wrong_call;
  }
  /* no file of the user's is read: the script says all */
#ifdef GMSH_INITIALIZE_MAY_RUN
  gmshInitialize(1, name, 0, 0, &failed);
#else
  gmshInitialize(1, name, 0, &failed);
#endif
  check(failed, "start");
  gmshOptionSetNumber("General.Terminal", 1, &failed);
  /* one thread and errors that stop: the same script gives the same mesh, or none */
  gmshOptionSetNumber("General.NumThreads", 1, &failed);
  check(failed, "be kept to one thread");
  gmshOptionSetNumber("General.AbortOnError", 3, &failed);
  check(failed, "be set to stop at errors");
  gmshOpen(words[1], &failed);
  check(failed, "read the script");
  gmshModelMeshGenerate(2, &failed);
  check(failed, "make the mesh");
  gmshWrite(words[2], &failed);
  check(failed, "write the mesh");
  gmshFinalize(&failed);
  return done;
}
