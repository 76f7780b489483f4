/* Programs that end, or give the library back, while its threads are there: they end with their own status.
   The argument is the path of the library. Each case is a process of its own. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "flaunay/flaunay.h"

enum { POINTS = 20000, FEW = 300, WORKERS = 4, STATUS = 42 };

static const char* library_path;
static double points[2 * POINTS];

static struct {
  void* handle;
  __typeof__(&flaunay_triangulator_create) create;
  __typeof__(&flaunay_triangulator_destroy) destroy;
  __typeof__(&flaunay_triangulate) triangulate;
  __typeof__(&flaunay_triangulation_destroy) destroy_mesh;
  __typeof__(&flaunay_last_error) last_error;
} library;

/* ISO C has no cast from what dlsym returns to a function. */
static void find(const char* name, void* function) {
  void* found = dlsym(library.handle, name);
  if (found == NULL) abort();
  memcpy(function, &found, sizeof found);
}

static void load(void) {
  library.handle = dlopen(library_path, RTLD_NOW | RTLD_LOCAL);
  if (library.handle == NULL) {
    fprintf(stderr, "%s\n", dlerror());
    abort();
  }
  find("flaunay_triangulator_create", &library.create);
  find("flaunay_triangulator_destroy", &library.destroy);
  find("flaunay_triangulate", &library.triangulate);
  find("flaunay_triangulation_destroy", &library.destroy_mesh);
  find("flaunay_last_error", &library.last_error);
}

static void check(flaunay_status status) {
  if (status == FLAUNAY_SUCCESS) return;
  fprintf(stderr, "%s\n", library.last_error());
  abort();
}

static flaunay_triangulator* make(void) {
  flaunay_triangulator* triangulator = NULL;
  check(library.create("host", &triangulator));
  return triangulator;
}

static void triangulate(flaunay_triangulator* triangulator, size_t n) {
  flaunay_triangulation* mesh = NULL;
  const flaunay_options options = {.mode = FLAUNAY_MODE_BLOCKS};
  check(library.triangulate(triangulator, points, n, NULL, 1, &options, &mesh));
  library.destroy_mesh(mesh);
}

/* Never ends. */
static void* work(void* shared) {
  (void)shared;
  for (;;) {
    flaunay_triangulator* own = make();
    triangulate(own, POINTS);
    triangulate(own, FEW);
    library.destroy(own);
  }
  return NULL;
}

static void start_workers(void) {
  for (int k = 0; k < WORKERS; ++k) {
    pthread_t thread;
    if (pthread_create(&thread, NULL, work, NULL) != 0) abort();
  }
}

static void exit_while_threads_work(int round) {
  load();
  start_workers();
  usleep((unsigned)(1000 * (3 + 7 * round)));
  exit(STATUS);
}

static void exit_with_idle_threads(int round) {
  (void)round;
  load();
  triangulate(make(), POINTS);
  exit(STATUS);
}

static flaunay_triangulator* kept;
static void destroy_kept(void) {
  triangulate(kept, FEW);
  triangulate(kept, POINTS);
  library.destroy(kept);
}

/* The handler comes after those that the library registers when it is loaded. */
static void use_at_exit(int round) {
  (void)round;
  atexit(destroy_kept);
  load();
  kept = make();
  triangulate(kept, FEW);
  exit(STATUS);
}

static pthread_barrier_t barrier;
static void* use_and_stay(void* shared) {
  flaunay_triangulator* own = make();
  triangulate(own, FEW);
  triangulate(own, POINTS);
  library.destroy(own);
  pthread_barrier_wait(&barrier);
  /* The library is closed now. */
  pthread_barrier_wait(&barrier);
  return shared;
}

/* Threads that have used the library end after it was closed; then it is loaded again. */
static void close_and_load_again(int round) {
  (void)round;
  for (int k = 0; k < 5; ++k) {
    load();
    pthread_barrier_init(&barrier, NULL, 2);
    pthread_t thread;
    if (pthread_create(&thread, NULL, use_and_stay, NULL) != 0) abort();
    pthread_barrier_wait(&barrier);
    flaunay_triangulator* own = make();
    triangulate(own, POINTS);
    library.destroy(own);
    if (dlclose(library.handle) != 0) abort();
    pthread_barrier_wait(&barrier);
    pthread_join(thread, NULL);
  }
  exit(STATUS);
}

/* The child has none of the threads of its parent, which may hold locks as it is forked. */
static void fork_while_threads_work(int round) {
  load();
  start_workers();
  usleep((unsigned)(1000 * (3 + 7 * round)));
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);
    flaunay_triangulator* own = make();
    triangulate(own, POINTS);
    library.destroy(own);
    _exit(STATUS);
  }
  int status = 0;
  waitpid(child, &status, 0);
  _exit(WIFEXITED(status) ? WEXITSTATUS(status) : 1);
}

static int failures = 0;
static void run(const char* name, void (*program)(int round), int rounds) {
  for (int round = 0; round < rounds; ++round) {
    const pid_t child = fork();
    if (child == 0) {
      alarm(60);
      program(round);
      _exit(1);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) abort();
    if (WIFEXITED(status) && WEXITSTATUS(status) == STATUS) continue;
    fprintf(stderr, "%s, round %d: status %d, signal %d\n", name, round, WEXITSTATUS(status),
            WIFSIGNALED(status) ? WTERMSIG(status) : 0);
    ++failures;
  }
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  library_path = argv[1];
  unsigned long state = 1;
  for (size_t k = 0; k < 2 * POINTS; ++k) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    points[k] = (double)(state >> 33);
  }
  setenv("FLAUNAY_THREADS", "3", 1);
  run("exit while threads work", exit_while_threads_work, 12);
  run("exit with idle threads", exit_with_idle_threads, 2);
  run("use at exit", use_at_exit, 2);
  run("close and load again", close_and_load_again, 2);
  /* The address sanitizer may hold locks of its own when a process is forked. */
#ifndef __SANITIZE_ADDRESS__
  run("fork while threads work", fork_while_threads_work, 12);
#else
  (void)fork_while_threads_work;
#endif
  return failures != 0;
}
