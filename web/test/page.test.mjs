// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The page in Chromium, from a file server on the loopback address

import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import test, { after, before, beforeEach } from 'node:test';
import { decode } from 'fast-png';
import { chromium } from 'playwright-core';
import {
    enlarge,
    floatsOfPfm,
    matchNatively,
    pageFolder,
    pairs,
    presets,
    sideBySide,
    workFolder,
    writePng,
} from './pictures.mjs';
import { serve } from './server.mjs';

const [builtIn, deep, poor] = pairs;
let server, browser, page;
const problems = [],
    requests = [];

function watch(watched) {
    watched.on('console', message => {
        if (message.type() === 'error') problems.push(message.text());
    });
    watched.on('pageerror', error => problems.push(String(error)));
    watched.on('request', request => requests.push(request.url()));
}

async function openPage(options) {
    const opened = await browser.newContext({ viewport: { width: 1440, height: 900 }, ...options });
    const newPage = await opened.newPage();
    watch(newPage);
    await newPage.goto(server.address);
    await matched(newPage);
    return [opened, newPage];
}

// Waits for a run after the last one that this function has seen.
async function matched(on = page) {
    await on.waitForFunction(() => document.body.dataset.run && document.body.dataset.run !== window.lastRun, null, {
        timeout: 60000,
    });
    await on.evaluate(() => {
        window.lastRun = document.body.dataset.run;
    });
}

async function choosePreset(preset) {
    if (await page.isChecked(`input[name=preset][value=${preset}]`)) return;
    await page.check(`input[name=preset][value=${preset}]`);
    await matched();
}

// Typed digits would be told twice: here, and when the field is left.
async function setNumber(name, value, field = `#parameter-${name}`) {
    await page.locator(field).evaluate((input, number) => {
        input.value = number;
        input.dispatchEvent(new Event('change'));
    }, value);
}

async function download(kind) {
    const [file] = await Promise.all([page.waitForEvent('download'), page.click(`[data-download=${kind}]`)]);
    return readFileSync(await file.path());
}

const status = () => page.textContent('#status');

async function errorText() {
    await page.waitForSelector('#message:not([hidden])');
    return page.textContent('#message');
}

async function openBuiltIn() {
    await page.click('#built-in');
    await matched();
    assert.equal(await page.isVisible('#message'), false);
}

async function sameMap(pair, preset, options = []) {
    const expected = floatsOfPfm(matchNatively(pair, preset, 'expected.pfm', options));
    assert.deepEqual(floatsOfPfm(await download('pfm')), expected);
}

before(async () => {
    server = await serve(pageFolder);
    browser = await chromium.launch({
        executablePath: process.env.HDPSTEREO_BROWSER,
        args: [
            '--headless',
            '--no-sandbox',
            '--disable-quic',
            '--no-first-run',
            '--disable-background-networking',
            '--disable-component-update',
            '--disable-sync',
            '--enable-unsafe-swiftshader',
            '--use-fake-device-for-media-stream',
            '--use-fake-ui-for-media-stream',
        ],
    });
    [, page] = await openPage({ acceptDownloads: true, permissions: ['clipboard-read', 'clipboard-write'] });
});

beforeEach(async () => {
    await page.reload();
    await matched();
});

after(async () => {
    await browser?.close();
    server?.close();
});

test('the built-in pair, in every preset: the map of the native program', async () => {
    for (const preset of presets) {
        await choosePreset(preset);
        assert.match(await status(), new RegExp(`640 × 480 pixels, 64 disparities, ${preset}: \\d+ ms`));
        await sameMap(builtIn, preset);
    }
});

test('downloads are those of the native program', async () => {
    const expected = decode(matchNatively(builtIn, 'FAST', 'expected.png')),
        png = decode(await download('png'));
    assert.deepEqual([png.width, png.height, png.depth, png.channels], [640, 480, 16, 1]);
    assert.deepEqual(png.data, expected.data);

    const [ply, native] = [
        await download('ply'),
        matchNatively(builtIn, 'FAST', 'expected.ply', ['--focal=620', '--baseline=0.19']),
    ];
    const end = native.indexOf('end_header\n') + 11;
    assert.equal(ply.subarray(0, end).toString(), native.subarray(0, end).toString());
    assert.equal(ply.length, native.length);
    for (let at = end; at < ply.length; at += 15) {
        for (let i = 0; i < 12; i += 4) {
            const difference = Math.abs(ply.readFloatLE(at + i) - native.readFloatLE(at + i));
            assert.ok(difference <= 1e-6 * (1 + Math.abs(native.readFloatLE(at + i))));
        }
        assert.deepEqual(ply.subarray(at + 12, at + 15), native.subarray(at + 12, at + 15));
    }
});

test('the wipe shows the left image on one side and the map on the other', async () => {
    const samples = async () => {
        const { data, width, channels } = decode(await page.locator('#pictures').screenshot());
        const box = await page.locator('#pictures').boundingBox(),
            factor = box.width / 640;
        return [80, 560].map(x => {
            const pixel = Math.round(400 * factor) * width + Math.round(x * factor);
            return [...data.subarray(channels * pixel, channels * pixel + 3)];
        });
    };
    const canvasPixel = (id, x) =>
        page.evaluate(
            ([name, column]) => [
                ...document.getElementById(name).getContext('2d').getImageData(column, 400, 1, 1).data.slice(0, 3),
            ],
            [id, x],
        );
    const near = (a, b) =>
        assert.ok(
            a.every((value, i) => Math.abs(value - b[i]) < 40),
            `${a} and ${b}`,
        );
    await page.focus('#wipe');
    await page.keyboard.press('End');
    let [first, second] = await samples();
    near(first, await canvasPixel('left', 80));
    near(second, await canvasPixel('left', 560));
    await page.keyboard.press('Home');
    [first, second] = await samples();
    near(first, await canvasPixel('map', 80));
    near(second, await canvasPixel('map', 560));
    const center = await page.locator('#pictures').boundingBox();
    await page.mouse.click(center.x + center.width / 2, center.y + center.height / 2);
    assert.ok(Math.abs((await page.inputValue('#wipe')) - 50) < 3);
    assert.match(
        await page.textContent('#readout'),
        /\(\d+, \d+\) {2}[\d.]+ ± [\d.]+ px, depth [\d.]+, confidence \d+/,
    );
});

// The share of the map in a colour
const shareOf = color =>
    page.evaluate(([red, green, blue]) => {
        const map = document.getElementById('map'),
            { data } = map.getContext('2d').getImageData(0, 0, map.width, map.height);
        let count = 0;
        for (let i = 0; i < data.length; i += 4)
            count += data[i] === red && data[i + 1] === green && data[i + 2] === blue;
        return count / (data.length / 4);
    }, color);
const none = [20, 22, 26];

test('what has little confidence is grey', async () => {
    const greyShare = () => shareOf([120, 124, 132]);
    assert.equal(await greyShare(), 0);
    assert.ok(await page.isHidden('#confidence-note'));
    await page.fill('#threshold', '90');
    const share = await greyShare();
    assert.ok(share > 0.05 && share < 0.8, `${share}`);
    await page.click('[data-view=confidence]');
    assert.equal(await page.textContent('#scale-unit'), 'confidence');
    assert.ok(await page.isVisible('#confidence-note'));
});

test('the point cloud shows points, and turns', async () => {
    await page.click('[data-view=points]');
    const canvas = page.locator('#points canvas');
    await canvas.waitFor();
    await page.waitForTimeout(1000);
    const shot = async () => decode(await canvas.screenshot());
    const first = await shot(),
        colors = new Set();
    for (let i = 0; i < first.data.length; i += 4 * 97)
        colors.add((first.data[i] << 16) | (first.data[i + 1] << 8) | first.data[i + 2]);
    assert.ok(colors.size > 200, `${colors.size} colours`);
    await page.screenshot({ path: join(workFolder, 'points.png') });
    await canvas.focus();
    await page.keyboard.press('ArrowLeft');
    await page.waitForTimeout(500);
    assert.notDeepEqual((await shot()).data, first.data);
});

test('an uploaded pair of 16 bits, in every preset', async () => {
    await openFiles(deep.files);
    await matched();
    await setNumber('minDisparity', deep.minDisparity);
    await matched();
    await setNumber('numDisparities', deep.numDisparities);
    await matched();
    for (const preset of presets) {
        await choosePreset(preset);
        await sameMap(deep, preset);
    }
});

// As from the dialog of "Open pair": files, or their paths
async function openFiles(files, button = '#choose-pair') {
    const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.click(button)]);
    const buffers = [files].flat().map(file =>
        typeof file !== 'string'
            ? file
            : {
                  name: basename(file),
                  mimeType: { png: 'image/png', webm: 'video/webm' }[file.split('.').at(-1)] ?? 'text/plain',
                  buffer: readFileSync(file),
              },
    );
    await chooser.setFiles(buffers);
}

test('what the matcher found, and a parameter that changes the map', async () => {
    await openFiles([...poor.files].reverse()); // in order by their names
    await matched();
    const found = await page.textContent('#found');
    assert.match(found, /Rows *moved by -?[12]\.\d\d pixels/);
    assert.match(found, /Light *of the right image changed, gain 1\.\d\d/);
    assert.match(found, /Noise *[\d.]+ of 255 levels, so both images were smoothed/);
    assert.match(found, /Searched *\d+ % in layer \d/);
    assert.ok((await page.locator('#times li').count()) > 5);
    await openBuiltIn();
    const before = await download('pfm');
    await page.evaluate(() =>
        document.querySelectorAll('details.group').forEach(group => {
            group.open = true;
        }),
    );
    await setNumber('P1', 3);
    await matched();
    assert.notDeepEqual(await download('pfm'), before);
    assert.match(await page.textContent('#code-cpp'), /params\.P1 = 3;/);
    assert.match(await page.textContent('#code-python'), /params\.P1 = 3\nmatcher\.setParams/);
    await page.selectOption('#parameter-treeStrategy', 'RT');
    await matched();
    assert.match(await page.textContent('#code-cpp'), /params\.treeStrategy = cv::stereo::createRandomTree\(\);/);
    await page.click('[data-copy=code-cpp]');
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), await page.textContent('#code-cpp'));
    await page.click('#reset');
    await matched();
    assert.deepEqual(await download('pfm'), before);
});

test('a range that is not known is found, and stays to go on with', async () => {
    await page.check('#find-range');
    await matched();
    await sameMap({ ...builtIn, numDisparities: 0 }, 'FAST');
    const [, first, last] = (await page.textContent('#found')).match(/Range *(-?\d+) to (\d+) pixels, found/);
    const count = last - first + 1;
    assert.match(await status(), new RegExp(`640 × 480 pixels, ${count} disparities, FAST`));
    assert.match(await page.textContent('#code-cpp'), /create\(\s*0, 0, /);
    assert.ok(await page.isDisabled('#parameter-numDisparities'));
    await page.uncheck('#find-range');
    await matched();
    assert.equal(await page.inputValue('#parameter-numDisparities'), String(count));
    await sameMap({ ...builtIn, minDisparity: Number(first), numDisparities: count }, 'FAST');
    assert.ok(!(await page.textContent('#found')).includes('pixels, found'));

    const blank = ['left', 'right'].map(side =>
        writePng(`bare_${side}.png`, { width: 64, height: 48, channels: 1, data: new Uint8Array(64 * 48) }),
    );
    await page.check('#find-range');
    await matched();
    await openFiles(blank);
    assert.match(await errorText(), /too few corners match to find its range/);
    await page.uncheck('#find-range');
    await matched();
});

test('masks: with the pair or after it, of either image', async () => {
    const black = (name, [x0, x1], size = [640, 480]) => {
        const [width, height] = size,
            data = new Uint8Array(width * height);
        for (let i = 0; i < data.length; i++) data[i] = i % width >= x0 && i % width < x1 ? 0 : 255;
        return writePng(name, { width, height, channels: 1, data });
    };
    const left = black('mask_left.png', [100, 200]),
        right = black('mask_right.png', [300, 340]);
    const options = [`--left-mask=${left}`, `--right-mask=${right}`];
    await openFiles([right, ...builtIn.files, left]);
    await matched();
    await setNumber('numDisparities', 64);
    await matched();
    await sameMap(builtIn, 'FAST', options);
    assert.ok(Math.abs((await shareOf(none)) - 100 / 640) < 1e-6);
    assert.match(await page.textContent('#known summary'), /: mask of the left image, mask of the right image$/);
    assert.match(await page.textContent('#code-cpp'), /setMasks\(leftMask, rightMask\);/);

    await page.click('#known summary');
    await page.click('[data-remove=leftMask]');
    await matched();
    await sameMap(builtIn, 'FAST', options.slice(1));
    assert.equal(await shareOf(none), 0);
    assert.match(await page.textContent('#code-python'), /setMasks\(None, right_mask\)/);
    await openFiles(black('small_mask.png', [0, 10], [64, 48]), '[data-choose=leftMask]');
    assert.match(await errorText(), /small_mask\.png is for images of 64 × 48 pixels\. These have 640 × 480\./);
    await page.click('#swap');
    await matched();
    assert.match(await page.textContent('#known summary'), /: mask of the left image$/);
    await openBuiltIn(); // another pair
    await sameMap(builtIn, 'FAST');
});

test('ranges of disparities, of each pixel or of a coarser picture', async () => {
    const range = (name, disparity, [width, height] = [640, 480]) => {
        const data = new Uint16Array(width * height);
        for (let i = 0; i < data.length; i++) data[i] = i % width < width / 2 ? 256 * disparity : 0; // none on the right
        return writePng(name, { width, height, channels: 1, data });
    };
    const smallest = range('smallest.png', 20),
        largest = range('largest.png', 30, [80, 60]);
    await openFiles(smallest);
    await matched();
    await sameMap(builtIn, 'FAST', [`--smallest=${smallest}`]);
    assert.match(await page.textContent('#known summary'), /: smallest disparities$/);
    assert.match(await page.textContent('#code-python'), /setDisparityRange\(smallest, largest\)/);
    await openFiles(largest);
    assert.match(
        await errorText(),
        /smallest\.png has 640 × 480 pixels, largest\.png 80 × 60\. They must have one size\./,
    );
    const coarse = range('smallest_coarse.png', 20, [80, 60]);
    await openFiles([coarse, largest]);
    await matched();
    await sameMap(builtIn, 'FAST', [`--smallest=${coarse}`, `--largest=${largest}`]);
    await openBuiltIn();
    await sameMap(builtIn, 'FAST');
});

test('disparities that are about known, and findings of another pair', async () => {
    const plain = await download('pfm'),
        [prior, findings] = ['disparity.pfm', 'findings.yml'].map(name => join(workFolder, name));
    writeFileSync(prior, matchNatively(builtIn, 'QUALITY', 'prior.pfm'));
    await openFiles(prior);
    await matched();
    await sameMap(builtIn, 'FAST', [`--prior=${prior}`]);
    assert.notDeepEqual(await download('pfm'), plain);
    await page.click('#known summary');
    await setNumber('sigma', 2, '#known-sigma');
    await matched();
    await sameMap(builtIn, 'FAST', [`--prior=${prior}`, '--prior-sigma=2']);
    const png = join(workFolder, 'prior.png');
    matchNatively(builtIn, 'QUALITY', 'prior.png');
    await openFiles(png, '[data-choose=disparity]');
    await matched();
    await sameMap(builtIn, 'FAST', [`--prior=${png}`, '--prior-sigma=2']);
    await openFiles(builtIn.files[0], '[data-choose=disparity]');
    assert.match(await errorText(), /built-in_left\.png is no map of disparities/);
    await openBuiltIn();

    await openFiles(poor.files);
    await matched();
    writeFileSync(findings, await download('findings'));
    const { width, height, channels } = poor.images.left,
        size = width * channels;
    const files = ['left', 'right'].map(side => {
        const data = poor.images[side].data.slice(); // the upper half is bare
        data.fill(128, 0, size * (height >> 1));
        return writePng(`bare_${side}.png`, { width, height, channels, data });
    });
    await page.check('#find-range');
    await matched();
    await openFiles([...files, findings]);
    await matched();
    await sameMap({ files, minDisparity: 0, numDisparities: 0 }, 'FAST', [`--findings=${findings}`]);
    assert.match(
        await page.textContent('#code-python'),
        /setPairModel\(hdpstereo\.PairModel\.load\("findings\.yml"\)\)/,
    );
    await openFiles(files); // stay for pairs of this size
    await matched();
    await sameMap({ files, minDisparity: 0, numDisparities: 0 }, 'FAST', [`--findings=${findings}`]);
    const wrong = { name: 'notes.yml', mimeType: 'text/yaml', buffer: Buffer.from('some notes') };
    await openFiles(wrong, '[data-choose=findings]');
    assert.match(await errorText(), /notes\.yml has no findings/);
    await page.uncheck('#find-range');
    await matched();
    await openBuiltIn();
    assert.equal(await page.textContent('#known-summary'), '');
    await sameMap(builtIn, 'FAST');
});

test('how much disparities may be wrong, and why they are what they are', async () => {
    await page.evaluate(() => document.querySelectorAll('details.group').forEach(group => (group.open = true)));
    await setNumber('disp12MaxDiff', 1);
    await matched();
    await page.click('[data-view=sigma]');
    assert.ok(await page.isVisible('#sigma-note'));
    assert.equal(await page.textContent('#scale-unit'), 'pixels');
    const disparity = floatsOfPfm(await download('pfm')),
        sigma = floatsOfPfm(await download('sigma'));
    assert.ok(sigma.every((value, i) => value > 0 && Number.isFinite(value) === Number.isFinite(disparity[i])));
    const rejected = sigma.filter(value => value === Infinity).length / sigma.length;
    assert.ok(rejected > 0.01);
    assert.ok(Math.abs((await shareOf(none)) - rejected) < 1e-6);
    await page.screenshot({ path: join(workFolder, 'sigma.png') });

    await page.click('[data-view=reasons]');
    assert.ok((await page.isHidden('#scale')) && (await page.isHidden('#sigma-note')));
    const legend = await page.locator('#legend li').allTextContents();
    const shares = legend.map(text => Number(text.match(/, ([\d.]+) %$/)[1]));
    assert.match(legend[0], /^seen in both images/);
    assert.ok(Math.abs(shares.reduce((sum, share) => sum + share, 0) - 100) < 0.3, `${legend}`);
    assert.ok(Math.abs(await shareOf([62, 155, 254])) > 0.5);
    const i = sigma.indexOf(Infinity),
        [x, y] = [i % 640, 479 - Math.floor(i / 640)], // the last row comes first
        box = await page.locator('#pictures').boundingBox();
    await page.dispatchEvent('#pictures', 'pointermove', {
        clientX: box.x + ((x + 0.5) * box.width) / 640,
        clientY: box.y + ((y + 0.5) * box.height) / 480,
    });
    assert.match(await page.textContent('#readout'), /rejected: left and right disagree|hidden|beyond/);
    await page.screenshot({ path: join(workFolder, 'reasons.png') });
});

test('a swapped pair gets a hint', async () => {
    assert.equal(await page.isVisible('#problem'), false);
    await page.click('#swap');
    await matched();
    assert.match(await page.textContent('#problem'), /swapped/);
    await page.click('#swap');
    await matched();
    assert.equal(await page.isVisible('#problem'), false);
});

test('one picture with both side by side; JPEG', async () => {
    await openFiles(writePng('both.png', sideBySide(builtIn.images)));
    await matched();
    await setNumber('numDisparities', 64);
    await matched();
    await sameMap(builtIn, 'FAST');

    const jpegs =
        (await page
            .evaluate(async () => {
                const texts = [];
                for (const side of ['left', 'right']) {
                    const bitmap = await createImageBitmap(await (await fetch(`pair/${side}.png`)).blob());
                    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
                    canvas.getContext('2d').drawImage(bitmap, 0, 0);
                    const blob = await canvas.convertToBlob({ type: 'image/jpeg', quality: 0.95 });
                    texts.push(btoa(String.fromCharCode(...new Uint8Array(await blob.arrayBuffer()))));
                }
                return texts;
            })
            .catch(async () => null)) ?? [];
    assert.equal(jpegs.length, 2);
    await openFiles(
        jpegs.map((text, i) => ({
            name: `${'LR'[i]}.jpg`,
            mimeType: 'image/jpeg',
            buffer: Buffer.from(text, 'base64'),
        })),
    );
    await matched();
    assert.match(await status(), /640 × 480/);
});

test('a wrong input gets a sentence, and the page goes on', async () => {
    const png = readFileSync(builtIn.files[0]);
    const large = Buffer.from(png.subarray(0, 64)); // its header says how large it is
    large.writeUInt32BE(10000, 16);
    large.writeUInt32BE(7000, 20);
    const blank = { width: 10000, height: 6000, channels: 1, data: new Uint8Array(6e7) };
    const wrong = [
        [builtIn.files[0], /built-in_left\.png is only one image\. Choose two/],
        [
            [builtIn.files[0], poor.files[1]],
            /sizes: built-in_left\.png has 640 × 480 pixels, poor_right\.png 411 × 303/,
        ],
        [[builtIn.files[0], deep.files[1]], /One of the images has 8 bits, and the other one 16/],
        [
            [builtIn.files[0], { name: 'large.png', mimeType: 'image/png', buffer: large }],
            /large\.png has 70 megapixels\. This page takes less than 60/,
        ],
        [
            [writePng('blank_left.png', blank), writePng('blank_right.png', blank)],
            /blank_left\.png has 60 megapixels\. This page takes less than 60/,
        ],
        [
            [builtIn.files[0], { name: 'notes.txt', mimeType: 'text/plain', buffer: Buffer.from('some notes') }],
            /notes\.txt is not an image/,
        ],
        [
            [builtIn.files[0], { name: 'broken.png', mimeType: 'image/png', buffer: png.subarray(0, 5000) }],
            /broken\.png/,
        ],
        [[builtIn.files[0], builtIn.files[1], poor.files[0]], /These are 3 files/],
    ];
    for (const [files, expected] of wrong) {
        await openFiles(files);
        assert.match(await errorText(), expected);
        await openBuiltIn();
        await sameMap(builtIn, 'FAST');
    }
    await setNumber('P1', 300);
    assert.match(await errorText(), /P1 must be in 0\.\.100, not 300/);
    await page.click('#reset');
    await matched();
    await setNumber('numDisparities', -1);
    assert.match(await errorText(), /numDisparities must be >= 0, not -1/);
    await openBuiltIn();
});

test('a new choice cancels the run before, and the page answers meanwhile', async () => {
    const files = ['left', 'right'].map(side => writePng(`large_${side}.png`, enlarge(builtIn.images[side], 5)));
    await openFiles(files);
    await matched();
    await page.evaluate(() => {
        window.longest = 0;
        let last = performance.now();
        const tick = () => {
            window.longest = Math.max(window.longest, performance.now() - last);
            last = performance.now();
            requestAnimationFrame(tick);
        };
        tick();
    });
    await page.check('input[name=preset][value=PAPER]');
    await page.waitForSelector('#busy:not([hidden])');
    const runBefore = await page.evaluate(() => document.body.dataset.run);
    await page.evaluate(() => {
        window.longest = 0;
    });
    await page.waitForTimeout(800);
    assert.equal(await page.evaluate(() => document.body.dataset.run), runBefore, 'PAPER is still at work');
    assert.ok((await page.evaluate(() => window.longest)) < 300, 'the page answers');
    await choosePreset('ULTRAFAST');
    assert.match(await status(), /ULTRAFAST/);
    await page.check('input[name=preset][value=PAPER]');
    await page.waitForSelector('#busy:not([hidden])');
    await page.click('#cancel');
    assert.equal(await status(), 'Cancelled.');
    assert.equal(await page.isVisible('#busy'), false);
    await page.check('input[name=preset][value=FAST]');
    await matched();
    await page.check('input[name=preset][value=PAPER]');
    await page.waitForSelector('#busy:not([hidden])');
    await Promise.all([page.waitForEvent('worker'), openBuiltIn()]); // other images end it, too
    await sameMap(builtIn, 'PAPER');
});

test('a video of frames side by side runs live, with and without temporal prediction', async () => {
    const text = await page.evaluate(async () => {
        const bitmaps = await Promise.all(
            ['left', 'right'].map(async side => createImageBitmap(await (await fetch(`pair/${side}.png`)).blob())),
        );
        const canvas = Object.assign(document.createElement('canvas'), { width: 640, height: 240 });
        const drawing = canvas.getContext('2d'),
            recorder = new MediaRecorder(canvas.captureStream(15), { mimeType: 'video/webm' });
        const parts = [];
        recorder.ondataavailable = ({ data }) => parts.push(data);
        const ended = new Promise(resolve => {
            recorder.onstop = resolve;
        });
        recorder.start();
        for (let frame = 0; frame < 20; frame++) {
            bitmaps.forEach((bitmap, i) => drawing.drawImage(bitmap, frame, 0, 600, 480, 320 * i, 0, 320, 240));
            await new Promise(resolve => setTimeout(resolve, 66));
        }
        recorder.stop();
        await ended;
        const bytes = new Uint8Array(await new Blob(parts).arrayBuffer());
        return btoa(Array.from(bytes, byte => String.fromCharCode(byte)).join(''));
    });
    writeFileSync(join(workFolder, 'video.webm'), Buffer.from(text, 'base64'));
    await openFiles(join(workFolder, 'video.webm'), '#open-video');
    const frames = () => page.evaluate(() => Number(document.body.dataset.frames ?? 0));
    const more = async count => {
        const from = await frames();
        await page.waitForFunction(least => Number(document.body.dataset.frames) >= least, from + count, {
            timeout: 30000,
        });
    };
    await more(5);
    assert.match(await page.textContent('#fps'), /^\d+\.\d frames per second/);
    assert.match(await status(), /320 × 240 pixels/);
    assert.ok(!(await page.textContent('#times')).includes('temporal'));
    await page.check('#temporal');
    await more(5);
    assert.match(await page.textContent('#times'), /temporal prediction/);
    await page.click('[data-download=sigma]');
    assert.match(await errorText(), /choose “Expected error”/);
    await page.click('[data-view=sigma]');
    await more(3);
    assert.equal(floatsOfPfm(await download('sigma')).length, 320 * 240);
    await page.click('[data-view=reasons]');
    await more(3);
    assert.match(await page.textContent('#legend'), /seen in both images/);
    await page.click('[data-view=disparity]');
    await page.click('#pause');
    await page.waitForTimeout(300);
    const paused = await frames();
    await page.waitForTimeout(400);
    assert.equal(await frames(), paused);
    await page.click('#pause');
    await more(2);
    await setNumber('numDisparities', 32); // those of the pair come back
    await page.click('#stop-video');
    await matched();
    assert.equal(await page.isVisible('#video-bar'), false);
    await sameMap(builtIn, 'FAST');
});

test('a camera with one picture per frame gets a sentence', async () => {
    await page.click('#open-camera');
    assert.match(await errorText(), /The video has \d+ × \d+ pixels: its frames do not show two images side by side/);
    await openBuiltIn();
});

test('controls have names, and the keyboard reaches them', async () => {
    const unnamed = await page.evaluate(() =>
        [...document.querySelectorAll('button, input:not([type=file]), select')]
            .filter(
                control =>
                    !control.textContent.trim() && !control.getAttribute('aria-label') && !control.labels?.length,
            )
            .map(control => control.outerHTML),
    );
    assert.deepEqual(unnamed, []);
    await page.focus('#choose-left');
    const reached = new Set();
    for (let i = 0; i < 40; i++) {
        await page.keyboard.press('Tab');
        reached.add(await page.evaluate(() => document.activeElement.id || document.activeElement.name));
    }
    for (const id of ['choose-right', 'built-in', 'wipe', 'threshold', 'focal', 'preset', 'parameter-numDisparities'])
        assert.ok(reached.has(id), id);
});

test('screenshots: light, dark, and a phone', async () => {
    const looks = {
        light: {},
        dark: { colorScheme: 'dark' },
        phone: { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true },
    };
    for (const [name, options] of Object.entries(looks)) {
        const [opened, look] = await openPage(options);
        for (let i = 0; i < 10; i++) {
            await look.click('#built-in'); // until the code is compiled
            await matched(look);
        }
        await look.screenshot({ path: join(workFolder, `${name}.png`), fullPage: name === 'phone' });
        assert.equal(await look.evaluate(() => document.documentElement.scrollWidth > innerWidth), false, name);
        const ends = await look.evaluate(() =>
            [...document.querySelectorAll('[data-view]')].map(button => button.getBoundingClientRect().right),
        );
        assert.ok(Math.max(...ends) < (options.viewport?.width ?? 1440), `${name}: ${ends}`);
        await opened.close();
    }
});

test('with threads, if the host isolates the page: the same map', async () => {
    const headers = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };
    const isolated = await serve(pageFolder, { headers });
    const opened = await browser.newContext({ acceptDownloads: true });
    const before = page;
    try {
        page = await opened.newPage();
        watch(page);
        await page.goto(isolated.address);
        await matched();
        assert.match(await page.textContent('#engine'), /\d+ threads/);
        for (const preset of presets) {
            await choosePreset(preset);
            await sameMap(builtIn, preset);
        }
    } finally {
        page = before;
        await opened.close();
        isolated.close();
    }
});

test('nothing is fetched from elsewhere, and nothing goes wrong on the way', () => {
    const elsewhere = requests.filter(address => !/^(blob:|data:|http:\/\/127\.0\.0\.1:)/.test(address));
    assert.ok(requests.length > 50);
    assert.deepEqual(elsewhere, []);
    assert.deepEqual(problems, []);
});
