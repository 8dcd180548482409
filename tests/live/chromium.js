'use strict';
// Headless Chromium by its debugging pipe: a page, what it says on its console, input, pictures.
const {spawn} = require('child_process');
const fs = require('fs'), os = require('os'), path = require('path');

async function open(program, file, {width = 1400, height = 1000, dark = false} = {}) {
  const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'live-'));
  const child = spawn(program, ['--headless=new', '--no-sandbox', '--remote-debugging-pipe', `--user-data-dir=${profile}`, '--no-first-run',
    '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-dev-shm-usage', '--hide-scrollbars', 'about:blank'],
    {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
  const waiting = new Map(), errors = [];
  let number = 0, rest = Buffer.alloc(0), session;
  child.stdio[4].on('data', data => {
    rest = Buffer.concat([rest, data]);
    for (let end; (end = rest.indexOf(0)) >= 0; rest = rest.subarray(end + 1)) {
      const message = JSON.parse(rest.subarray(0, end).toString());
      if (message.id) {
        const {resolve, reject} = waiting.get(message.id);
        waiting.delete(message.id);
        message.error ? reject(new Error(message.error.message)) : resolve(message.result);
      } else if (message.method === 'Runtime.exceptionThrown') {
        errors.push(message.params.exceptionDetails.exception?.description || message.params.exceptionDetails.text);
      } else if (message.method === 'Runtime.consoleAPICalled' && ['error', 'assert'].includes(message.params.type)) {
        errors.push(message.params.args.map(a => a.value || a.description).join(' '));
      } else if (message.method === 'Log.entryAdded' && message.params.entry.level === 'error') {
        errors.push(message.params.entry.text);
      }
    }
  });
  const send = (method, params = {}) => new Promise((resolve, reject) => {
    waiting.set(++number, {resolve, reject});
    child.stdio[3].write(JSON.stringify({id: number, method, params, ...(session ? {sessionId: session} : {})}) + '\0');
  });
  const {targetInfos} = await send('Target.getTargets');
  const {targetId} = targetInfos.find(t => t.type === 'page');
  session = (await send('Target.attachToTarget', {targetId, flatten: true})).sessionId;
  for (const domain of ['Runtime', 'Log', 'Page']) await send(domain + '.enable');
  const look = async (w, h, isDark) => {
    await send('Emulation.setDeviceMetricsOverride', {width: w, height: h, deviceScaleFactor: 1, mobile: false});
    await send('Emulation.setEmulatedMedia', {features: [{name: 'prefers-color-scheme', value: isDark ? 'dark' : 'light'}]});
  };
  await look(width, height, dark);
  await send('Page.navigate', {url: 'file://' + path.resolve(file)});

  /// The value of an expression in the page, which may be a promise.
  const value = async expression => {
    const {result, exceptionDetails} = await send('Runtime.evaluate', {expression, awaitPromise: true, returnByValue: true});
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description || exceptionDetails.text);
    return result.value;
  };
  const sleep = ms => new Promise(resolve => setTimeout(resolve, ms));
  const until = async (expression, seconds) => {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end; await sleep(50))
      if (await value(`Boolean(${expression})`).catch(() => false)) return true;
    return false;
  };
  const mouse = (type, x, y, buttons = 0) => send('Input.dispatchMouseEvent', {type, x, y, button: type === 'mouseMoved' && !buttons ? 'none' : 'left', buttons, clickCount: type === 'mousePressed' ? 1 : 0});
  const key = async name => { for (const type of ['keyDown', 'keyUp']) await send('Input.dispatchKeyEvent', {type, key: name, code: name}); };
  const picture = async (to, whole = false) => {
    const {data} = await send('Page.captureScreenshot', {format: 'png', captureBeyondViewport: whole});
    fs.writeFileSync(to, Buffer.from(data, 'base64'));
  };
  const close = async () => {
    await send('Browser.close').catch(() => {});
    if (child.exitCode === null) await Promise.race([new Promise(resolve => child.on('exit', resolve)), sleep(5000)]);
    child.kill('SIGKILL');
    fs.rmSync(profile, {recursive: true, force: true, maxRetries: 5});
  };
  return {value, until, mouse, key, picture, look, sleep, errors, close};
}

module.exports = {open};
