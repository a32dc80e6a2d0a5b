// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The lines of C++ and Python that give the map of the page

import { strategies } from './controls.mjs';

function valueInCode(name, value, { parameters, enumerations }, scope, isPython) {
    const parameter = parameters.find(p => p.name === name);
    if (!parameter) return null;
    const found = Object.entries(enumerations).find(
        ([title]) => parameter.kind === 'int' && name.toLowerCase().endsWith(title.toLowerCase()),
    );
    if (found) return `${scope}${found[1].find(option => option.value === value).name}`;
    if (parameter.kind === 'bool') return isPython ? (value ? 'True' : 'False') : String(value);
    return String(value);
}

function changesInCode(settings, documentation, isPython) {
    const scope = isPython ? 'hdpstereo.HDPTreeMatcher.' : 'HDPTreeMatcher::',
        call = isPython ? 'matcher.' : 'matcher->',
        end = isPython ? '\n' : ';\n';
    let setters = '',
        fields = '';
    for (const [name, value] of Object.entries(settings.changes)) {
        const parameter = documentation.parameters.find(p => p.name === name),
            strategy = strategies.find(s => name === 'treeStrategy' && s.name === value),
            argument = strategy
                ? `${isPython ? 'hdpstereo.' : 'cv::stereo::'}${strategy.factory}()`
                : valueInCode(name, value, documentation, scope, isPython);
        if (parameter?.method) setters += `${call}set${parameter.method}(${argument})${end}`;
        else fields += `params.${name} = ${argument}${end}`;
    }
    if (fields)
        fields = `${isPython ? '' : 'auto '}params = ${call}getParams()${end}${fields}${call}setParams(params)${end}`;
    return setters + fields;
}

function knownInCode({ leftMask, rightMask, smallest, disparity, sigma, findings }, isPython) {
    const call = isPython ? 'matcher.' : 'matcher->',
        end = isPython ? '\n' : ';\n',
        mask = (image, side) =>
            image ? (isPython ? `${side}_mask` : `${side}Mask`) : isPython ? 'None' : 'cv::noArray()',
        model = isPython ? 'hdpstereo.PairModel.load' : 'cv::stereo::PairModel::load';
    return (
        (leftMask || rightMask ? `${call}setMasks(${mask(leftMask, 'left')}, ${mask(rightMask, 'right')})${end}` : '') +
        (smallest ? `${call}setDisparityRange(smallest, largest)${end}` : '') +
        (disparity ? `${call}setPriorDisparity(known, ${sigma})${end}` : '') +
        (findings ? `${call}setPairModel(${model}("findings.yml"))${end}` : '')
    );
}

export function codeOf(settings, known, documentation) {
    const { minDisparity, numDisparities, preset } = settings;
    const cpp =
        'using cv::stereo::HDPTreeMatcher;\n' +
        'auto matcher = HDPTreeMatcher::create(\n' +
        `    ${minDisparity}, ${numDisparities}, HDPTreeMatcher::PRESET_${preset});\n` +
        changesInCode(settings, documentation, false) +
        knownInCode(known, false) +
        'cv::Mat disparity;\n' +
        'matcher->compute(left, right, disparity); // 16 * disparity';
    const python =
        'import hdpstereo\n' +
        'matcher = hdpstereo.HDPTreeMatcher.create(\n' +
        `    ${minDisparity}, ${numDisparities}, hdpstereo.HDPTreeMatcher.PRESET_${preset})\n` +
        changesInCode(settings, documentation, true) +
        knownInCode(known, true) +
        'disparity = matcher.compute(left, right)  # 16 * disparity';
    return { cpp, python };
}
