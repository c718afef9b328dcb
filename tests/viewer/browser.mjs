// Debian's Chromium driven by playwright-core, for tests of the page. Both are optional: without them a test says so and is skipped.
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';
import path from 'node:path';

export const kSkipped = 77; // ctest's SKIP_RETURN_CODE

export function skip(why) {
  console.log(`skipped: ${why}`);
  process.exit(kSkipped);
}

function findBrowser() {
  const names = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
  return process.env.WARETWIN_CHROMIUM ?? names.find((name) => existsSync(name));
}

// WebGL by software, since test machines have no graphics card; `webgl: false` as on machines that have none at all.
export async function launch({ webgl = true } = {}) {
  const executablePath = findBrowser();
  if (!executablePath) skip('no Chromium; install the package chromium');
  const modules = process.env.WARETWIN_VIEWER_MODULES ?? '';
  if (!existsSync(path.join(modules, 'playwright-core'))) skip('no playwright-core; build the viewer (node, npm)');
  const { chromium } = createRequire(path.join(modules, 'tests.js'))('playwright-core');
  const graphics = webgl ? ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] : ['--disable-gpu', '--disable-3d-apis'];
  return chromium.launch({ executablePath, headless: true, args: ['--no-sandbox', '--disable-dev-shm-usage', ...graphics] });
}

// Opens a page from disk and fails on anything that the console calls an error. `seconds`: until the page says that it is there.
export async function open(browser, file, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1366, height: 768 }, ...options });
  const problems = [];
  page.on('console', (message) => message.type() === 'error' && problems.push(message.text()));
  page.on('pageerror', (error) => problems.push(String(error)));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url())) problems.push(`asks for ${request.url()}`);
  });
  const begin = performance.now();
  await page.goto(pathToFileURL(file).href, { waitUntil: 'load' });
  await page.waitForSelector('body[data-ready]', { timeout: 30000 });
  // Two frames later it is on the screen.
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  return { page, problems, seconds: (performance.now() - begin) / 1000 };
}
