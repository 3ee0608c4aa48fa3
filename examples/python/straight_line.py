#!/usr/bin/env python3
"""A planner of its own, in Python: the straight line from start to goal, if the scene server finds it free. It does what
lcmtypes/README.md says under "One request, step by step"; lcm-gen and LCM's module `lcm` are needed."""
import collections, os, socket, subprocess, sys, tempfile, threading, time, uuid

import lcm

HERE = os.path.dirname(os.path.abspath(__file__))
TYPES = os.path.join(HERE, "..", "..", "lcmtypes")
with tempfile.TemporaryDirectory() as modules:
    subprocess.run(["lcm-gen", "--python", "--ppath", modules] +
                   [os.path.join(TYPES, f) for f in os.listdir(TYPES) if f.endswith(".lcm")], check=True)
    sys.path.insert(0, modules)
    import planbench as pb
    sys.path.remove(modules)

MODELS = ["spheres"]  # collision models of the scene server that this planner offers


class StraightLine:
    def __init__(self, name):
        self.name, self.channel = name, name.upper().replace("-", "_")
        self.lcm = lcm.LCM()  # $LCM_DEFAULT_URL
        self.start, self.current, self.sets, self.cancelled = self.utime(), None, None, ""
        self.instance = uuid.uuid4().hex[:16]
        self.results = collections.OrderedDict()
        self.reply, self.replied = None, threading.Condition()
        for channel, message, handler in (
                ("NODE_STATUS", pb.lcmt_node_status, self.on_status),
                ("PROBLEM_SETS", pb.lcmt_problem_sets, self.on_sets),
                ("DISCOVER", pb.lcmt_discover, lambda _: self.announce()),
                ("COLLISION_REPLY", pb.lcmt_collision_reply, self.on_reply),
                ("PLAN_REQUEST_" + self.channel, pb.lcmt_plan_request, self.on_request),
                ("PLAN_CANCEL_" + self.channel, pb.lcmt_plan_cancel, self.on_cancel)):
            self.subscribe(channel, message, handler)

    def subscribe(self, channel, message, handler):
        def on_bytes(_, data):
            try:
                read = message.decode(data)
            except Exception as error:
                print(f"{channel}: cannot be read as {message.__name__}: {error}", file=sys.stderr)
            else:
                handler(read)
        self.lcm.subscribe(channel, on_bytes)

    @staticmethod
    def utime():
        return int(time.time() * 1e6)

    def on_status(self, other):
        """Leaves to an older process of this name, as a newcomer; what is 10 s old is a recording that is played."""
        now = self.utime()
        if other.name != self.name or now - self.start > 3e6 or now - other.utime > 10e6:
            return
        if (other.start_utime, other.instance) < (self.start, self.instance):
            print(f"'{self.name}' is live already (host {other.host}, pid {other.pid}): choose another", file=sys.stderr)
            sys.exit(2)

    def on_sets(self, sets):
        self.sets = sets

    def on_reply(self, reply):
        with self.replied:
            self.reply = reply
            self.replied.notify_all()

    def on_cancel(self, cancel):
        with self.replied:
            self.cancelled = cancel.request_id
            self.replied.notify_all()
        self.send(self.results.get(cancel.request_id))

    def on_request(self, request):  # every copy is answered at once
        current, ack = self.current, pb.lcmt_plan_ack()  # before results, which another thread sets first
        if request.request_id in self.results:
            return self.send(self.results[request.request_id])
        ack.utime, ack.planner, ack.request_id = self.utime(), self.name, request.request_id
        ack.message = self.refusal(request)
        if ack.message:
            ack.verdict = ack.REFUSED
        else:
            if current is None:
                current = self.current = request
                threading.Thread(target=self.work, args=(request,), daemon=True).start()
            ack.verdict = ack.WORKING if current.request_id == request.request_id else ack.BUSY
        self.lcm.publish("PLAN_ACK_" + self.channel, ack.encode())

    def refusal(self, request):
        """Why a request cannot be worked on, "" if it can."""
        if self.sets and request.robot_id not in ("", self.sets.robot_id):
            return "it is for another robot"
        if request.collision_model not in MODELS:
            return "the collision model is not one of " + ", ".join(MODELS)
        if request.anytime or request.direction == request.BACKWARD or request.initial_path.num_waypoints:
            return "anytime, backward and initial_path are not supported"
        return ""

    def send(self, result):
        if result is not None:
            self.lcm.publish("PLAN_RESULT_" + self.channel, result.encode())

    def announce(self):
        if self.sets is None:
            return  # the robot's id is the scene server's
        current, status = self.current, pb.lcmt_node_status()
        status.utime, status.start_utime, status.instance, status.name = self.utime(), self.start, self.instance, self.name
        status.kind, status.state = status.KIND_PLANNER, status.STATE_BUSY if current else status.STATE_IDLE
        status.request_id = current.request_id if current else ""
        status.host, status.pid, status.version, status.commit = socket.gethostname(), os.getpid(), "example", "example"
        status.robot_name, status.robot_id = self.sets.robot_name, self.sets.robot_id
        status.algorithm, status.planner_class = "Straight line (Python)", "search-and-sample"
        status.deterministic, status.num_collision_models, status.collision_model = True, len(MODELS), MODELS
        self.lcm.publish("NODE_STATUS", status.encode())

    def ask(self, question, deadline, request_id):
        """The reply; None if the request is cancelled or the deadline comes."""
        def answered():
            return self.reply is not None and self.reply.request_id == question.request_id

        while time.monotonic() < deadline and self.cancelled != request_id:  # again until it is answered
            self.lcm.publish("COLLISION_REQUEST", question.encode())
            with self.replied:
                self.replied.wait_for(lambda: answered() or self.cancelled == request_id, 0.25)
                if answered():
                    return self.reply
        return None

    def work(self, request):
        begin, question, result = time.monotonic(), pb.lcmt_collision_request(), pb.lcmt_plan_result()
        at = dict(zip(request.start.joint_name, request.start.position))
        # The group's joints in its order; alternatives follow one another, and this planner takes the first.
        joints = list(dict.fromkeys(goal.joint_name for goal in request.goal))
        line = [[at[joint] for joint in joints], [goal.position for goal in request.goal[:len(joints)]]]
        question.utime, question.request_id = self.utime(), self.name + "-" + str(uuid.uuid4())
        for field in ("scene_id", "group", "collision_model", "edge_resolution_m", "edge_check"):
            setattr(question, field, getattr(request, field))
        question.state, question.num_joints, question.num_edges = request.start, len(joints), 1
        question.edge_from, question.edge_to = [line[0]], [line[1]]
        reply = self.ask(question, begin + request.time_limit_s, request.request_id)
        result.planner, result.run_id, result.request_id = self.name, request.run_id, request.request_id
        if reply is None and self.cancelled == request.request_id:
            result.status, result.message = result.CANCELLED, "cancelled"
        elif reply is None or not reply.ok:
            result.status = result.TIMED_OUT if reply is None else result.INVALID_REQUEST
            result.message = "no answer about collisions" if reply is None else reply.message
        elif reply.edge[0].free and reply.edge[0].within_limits:
            result.status = result.SOLVED
            for path in [result.path] + ([result.simplified_path] if request.simplify else []):
                path.num_joints, path.num_waypoints, path.joint_name, path.position = len(joints), 2, joints, line
        else:
            result.status, result.message = result.EXHAUSTED, "the straight line is not free"
        result.planning_time_s = result.total_time_s = time.monotonic() - begin
        result.utime = self.utime()
        self.results[request.request_id] = result
        while len(self.results) > 64:
            self.results.popitem(last=False)
        self.current = None
        self.send(result)

    def run(self):
        while True:
            self.announce()
            end = time.monotonic() + 0.5
            while time.monotonic() < end:
                self.lcm.handle_timeout(50)


StraightLine(sys.argv[1] if len(sys.argv) > 1 else "straight").run()
