// What Emscripten's programs in Node lack: the environment, and the status of the standard streams.
Module['preRun'] = () => {
  Object.assign(ENV, process.env);
  FS.init();
  ['stdin', 'stdout', 'stderr'].forEach((name, file) => { FS.streams[file].path = `/dev/${name}`; });
};
