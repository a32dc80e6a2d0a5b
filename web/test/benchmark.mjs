// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The time of hdpstereo.wasm against that of the native program on one thread, in turns: the built-in pair of 640 x 480
// pixels with 64 disparities. PRESET_FAST may take eight times as long.

import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { nativeProgram, pageFolder, pairs, presets } from './pictures.mjs';

const runs = 9,
    most = 8;
const [pair] = pairs,
    { left, right } = pair.images;
const { default: create } = await import(pathToFileURL(join(pageFolder, 'hdpstereo.mjs')));
const hdp = await create({ wasmBinary: readFileSync(join(pageFolder, 'hdpstereo.wasm')) });

// The least time of some runs by hdp_benchmark
function nativeTime(preset) {
    const output = execFileSync(
        join(dirname(nativeProgram), 'hdp_benchmark'),
        [
            ...pair.files,
            `--num-disparities=${pair.numDisparities}`,
            `--methods=${preset.toLowerCase()}`,
            '--runs=3',
            '--threads=1',
        ],
        { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] },
    );
    return Number(output.match(new RegExp(`\\| ${preset.toLowerCase()} \\| [\\d.]+ \\| ([\\d.]+)`))[1]);
}

function webTime(matcher) {
    return Math.min(...[1, 2, 3].map(() => matcher.compute(left, right).milliseconds));
}

console.log('| preset | native ms | in the page ms | ratio |\n|---|---|---|---|');
let failed = false;
for (const preset of presets) {
    const matcher = hdp.HDPTreeMatcher.create(pair.minDisparity, pair.numDisparities, hdp[`PRESET_${preset}`]);
    for (let i = 0; i < 5; i++) matcher.compute(left, right); // until it is compiled
    let native = Infinity,
        web = Infinity;
    for (let run = 0; run < runs / 3; run++) {
        native = Math.min(native, nativeTime(preset));
        web = Math.min(web, webTime(matcher));
    }
    console.log(`| ${preset} | ${native.toFixed(1)} | ${web.toFixed(1)} | ${(web / native).toFixed(1)} |`);
    failed ||= preset === 'FAST' && web > most * native;
    matcher.delete();
}
if (failed) {
    console.error(`error: FAST takes more than ${most} times as long`);
    process.exitCode = 1;
}
