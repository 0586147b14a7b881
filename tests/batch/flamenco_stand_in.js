// SPDX-License-Identifier: GPL-3.0-or-later
//
// A small stand-in for Flamenco's job compiler, after its documentation: `author.Task(name, type)`,
// `author.Command(name, parameters)`, `task.addCommand`, `task.addDependency`, `job.addTask`, the types of settings and
// tasks. It is stricter than needed: what is not documented is an error. The test puts the job type between the two
// halves of this file, where the line of equal signs is.

var SETTING_TYPES = { string: "string", int32: "number", float: "number", bool: "boolean" };
var SETTING_FIELDS = ["key", "type", "subtype", "choices", "propargs", "description", "label", "default", "eval",
    "evalInfo", "visible", "required", "editable"];
var VISIBLE = ["visible", "hidden", "submission", "web"];
var SUBTYPES = ["file_path", "dir_path", "file_name", "hashed_file_path"];
var TASK_TYPES = ["blender", "ffmpeg", "file-management", "misc"];
var COMMANDS = { exec: { exe: "string", args: "object" } };

function demand(condition, message) {
    if (!condition) {
        throw new Error(message);
    }
}

var author = {
    Task: function (name, type) {
        demand(typeof name === "string" && name !== "", "a task needs a name");
        demand(TASK_TYPES.indexOf(type) >= 0, "unknown type of task: " + type);
        return {
            name: name, type: type, commands: [],
            addCommand: function (command) { this.commands.push(command); },
        };
    },
    Command: function (name, parameters) {
        demand(name in COMMANDS, "unknown command: " + name);
        for (var key in parameters) {
            demand(typeof parameters[key] === COMMANDS[name][key], name + ": wrong parameter " + key);
        }
        demand(Array.isArray(parameters.args), "args is not a list");
        parameters.args.forEach(function (argument) {
            demand(typeof argument === "string", "an argument is not a text: " + argument);
        });
        return { name: name, parameters: parameters };
    },
};
//====
function checkedSettings(given) {
    var settings = {};
    JOB_TYPE.settings.forEach(function (setting) {
        for (var field in setting) {
            demand(SETTING_FIELDS.indexOf(field) >= 0, "unknown field of a setting: " + field);
        }
        demand(setting.type in SETTING_TYPES, "unknown type of setting: " + setting.type);
        demand(!("visible" in setting) || VISIBLE.indexOf(setting.visible) >= 0, "unknown: " + setting.visible);
        demand(!("subtype" in setting) || SUBTYPES.indexOf(setting.subtype) >= 0, "unknown: " + setting.subtype);
        var value = setting.key in given ? given[setting.key] : setting["default"];
        demand(!setting.required || value !== undefined, setting.key + " is required");
        demand(value === undefined || typeof value === SETTING_TYPES[setting.type], setting.key + ": wrong type");
        settings[setting.key] = value;
    });
    return settings;
}

function compiled(given) {
    demand(typeof JOB_TYPE.label === "string", "a job type needs a label");
    var job = { settings: checkedSettings(given), tasks: [], addTask: function (task) { this.tasks.push(task); } };
    compileJob(job);
    return job.tasks;
}

var show = typeof print === "function" ? print : console.log;
try {
    show(JSON.stringify({ tasks: compiled(GIVEN) }));
} catch (error) {
    show(JSON.stringify({ error: String(error.message) }));
}
