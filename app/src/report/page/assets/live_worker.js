// Runs the models in a thread of their own, so that the page never waits. Gets the compiled models once, then requests; answers each.
let models;
function ask(request) {
  const bytes = new TextEncoder().encode(JSON.stringify(request));
  const at = models.room(bytes.length);
  new Uint8Array(models.memory.buffer, at, bytes.length).set(bytes);
  const length = models.answer();
  return JSON.parse(new TextDecoder().decode(new Uint8Array(models.memory.buffer, models.answered(), length)));
}
onmessage = ({ data }) => {
  if (data.module) {
    models = new WebAssembly.Instance(data.module, {}).exports;
    return;
  }
  try {
    postMessage(ask(data.request));
  } catch (error) {
    postMessage({ error: `the model stopped: ${error.message}`, broken: true });
  }
};
